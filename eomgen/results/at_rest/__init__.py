"""Structures at rest, printed and drawn."""
