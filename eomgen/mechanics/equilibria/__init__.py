"""Where systems with freedoms rest, whether they are stable there, and what holds them."""
