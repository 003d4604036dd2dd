"""Start of a motion, the same for every verb, and the ways in which loops can be assembled there."""
