"""Small motions about an equilibrium or a steady motion: M, C, K, the state matrix, modes, stability."""
