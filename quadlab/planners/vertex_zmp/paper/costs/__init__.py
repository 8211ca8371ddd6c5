"""One cost of the nonlinear program per file."""
