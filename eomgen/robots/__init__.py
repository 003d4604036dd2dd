"""Files and objects of other programs <-> model files: URDF, MJCF, SDF, sympy.physics.mechanics."""
