"""Equations of motion: the system, the ways to derive them, accelerations, and properties known before any motion."""
