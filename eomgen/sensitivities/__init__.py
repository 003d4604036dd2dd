"""Derivatives by parameters and starts: of the right-hand side, of outputs, of a run, of small motions, of rest."""
