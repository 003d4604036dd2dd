"""Bodies of parts, moments and products of inertia, principal axes."""
