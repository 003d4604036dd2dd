"""What holds bodies at one configuration, and how they could move: structures and velocity plans."""
