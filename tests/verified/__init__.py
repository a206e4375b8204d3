"""The cases of VERIFICATION.md, by subject."""
