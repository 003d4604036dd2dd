"""Where bodies are and how they move: the symbols of a derivation, motions, masses, applied loads."""
