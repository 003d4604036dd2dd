"""What stays constant along the motion, and the laws of motion that follow."""
