"""First integrals, speeds as functions of the coordinates, and laws of motion in closed form."""
