"""Equations of motion: the system, the ways to derive them, accelerations, and what is known before anything moves."""
