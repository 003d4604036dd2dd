"""What a user declares: Model and its parts, and the reader of model files. Computes nothing."""
