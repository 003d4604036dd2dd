"""Values of expressions, in floats, intervals, the prime field or 50 digits, and their zeros."""
