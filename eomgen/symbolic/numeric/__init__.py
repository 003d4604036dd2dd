"""What expressions are worth: in floats, intervals, the prime field or 50 digits, and where they vanish."""
