"""Constraints: their rows, their rank, what they eliminate, and the states that satisfy them."""
