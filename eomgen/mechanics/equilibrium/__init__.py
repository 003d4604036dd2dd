"""Equilibria of systems with degrees of freedom: their places, their stability, the reactions there."""
