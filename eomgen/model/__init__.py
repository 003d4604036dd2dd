"""The declared model: Model and its parts, and the reader of model files. Computes nothing."""
