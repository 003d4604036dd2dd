"""Instants of motion, printed and drawn."""
