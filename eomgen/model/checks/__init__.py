"""Checks of a model as a whole: one file a concern, each a function Catalog -> diagnostics."""
