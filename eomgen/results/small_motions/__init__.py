"""Small motions as a user gets them."""
