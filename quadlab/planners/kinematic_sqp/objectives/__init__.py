"""Objectives of Gehring 2017, Table I, one a file."""
