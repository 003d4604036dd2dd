"""Derivatives by parameters and starts: of the right-hand side, outputs, runs, small motions and equilibria."""
