"""Small motions about a place of rest or a steady motion: M, C, K, the state matrix, modes, stability."""
