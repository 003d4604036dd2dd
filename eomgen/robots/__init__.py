"""Robot files of other programs <-> model files: URDF, MJCF, SDF."""
