"""Equilibria of systems with degrees of freedom: where they are, whether they are stable, what holds them."""
