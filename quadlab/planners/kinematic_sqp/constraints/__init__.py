"""Constraints (4), (6), (8), (10) and the start of Gehring 2017, one a file."""
