"""Reactions: the balance of every body, component by component."""
