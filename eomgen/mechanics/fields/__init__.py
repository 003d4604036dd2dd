"""The velocity and acceleration fields of rigid bodies: relative motion, kinds of motion, centrodes."""
