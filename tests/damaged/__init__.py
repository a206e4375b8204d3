"""Damaged files: what damages them, and the readers that must read or refuse them, by what they read."""
