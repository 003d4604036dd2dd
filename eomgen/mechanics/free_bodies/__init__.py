"""Bodies cut free: their wrenches, their own equations, friction, and reactions by name."""
