"""The judge: is an equation that somebody derived by hand right for a model, and if not, why."""
