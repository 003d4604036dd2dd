"""Structures at rest: the velocity plan, released mechanisms, virtual work, section forces, influence lines."""
