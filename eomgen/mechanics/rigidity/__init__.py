"""Rigidity of a system at one configuration: structures with their mobility, and plans of possible velocities."""
