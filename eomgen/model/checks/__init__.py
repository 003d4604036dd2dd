"""What can be wrong with a model as a whole: one file a concern, each a function Catalog -> findings."""
