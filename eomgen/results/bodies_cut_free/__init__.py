"""Bodies cut free, with all their forces, as data and drawn."""
