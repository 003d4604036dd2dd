"""What measured motions tell of masses, inertias, rotors, dampers and friction."""
