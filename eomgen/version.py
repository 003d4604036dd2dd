"""The version of eomgen."""

__version__ = "0.1.0"
