"""The figures of a trial, one a file."""
