"""Elements of formulas: exact numbers, nodes of the graph, the grammar of the model file, units, vectors."""
