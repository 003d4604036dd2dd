"""Mechanisms at one instant: freed bodies under their constraints, given velocities, centres of rotation."""
