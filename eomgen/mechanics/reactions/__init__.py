"""Reactions, the forces that given motions need, and the test that bodies are in balance at a state."""
