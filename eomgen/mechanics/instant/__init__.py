"""Mechanisms at one instant: freed bodies under their ties, given velocities, centres of rotation."""
