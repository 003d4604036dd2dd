"""The one start of a motion that every verb takes, and the ways in which loops can be assembled there."""
