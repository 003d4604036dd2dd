"""Reactions, the forces that given motions take, and whether bodies are in equilibrium at a state."""
