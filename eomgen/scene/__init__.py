"""Drawable elements of a model at a state, as data over the scalars of the graph."""
