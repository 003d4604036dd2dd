"""Exact solutions of equations: linear systems, and one equation in one unknown."""
