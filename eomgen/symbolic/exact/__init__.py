"""Exact forms of expressions: sums of terms, quotients and factors, equality, and results as a person writes them."""
