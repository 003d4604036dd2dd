"""Formulas: expression < numeric < print < exact < solve; each folder imports only from those before it."""
