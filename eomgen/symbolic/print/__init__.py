"""Printed forms of expressions: the order of a textbook, numbers, text that the grammar reads back, sympy."""
