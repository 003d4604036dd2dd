"""Mechanics of a model, over one graph of scalars: from where bodies are to equations of motion and rest."""
