"""Identification of masses, inertias, rotors, dampers and friction from measured motions."""
