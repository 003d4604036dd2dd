"""The version of eomgen."""

__version__ = "0.1.0"
SCHEMA_VERSION = 1  # of every JSON that leaves
