"""What formulas are made of: exact numbers, nodes of the graph, the grammar of the model file, units, vectors."""
