"""Constraints: their rows, their rank, the elimination of dependent speeds, and the states that satisfy them."""
