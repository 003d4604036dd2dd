"""Ties that close: where they hold, what stays free, starts, branches, singular positions."""
