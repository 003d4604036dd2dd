"""Kinematics and loads of bodies: the symbols of a derivation, poses and twists, masses, applied loads."""
