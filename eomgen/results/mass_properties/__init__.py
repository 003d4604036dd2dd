"""Moments of inertia, printed and drawn."""
