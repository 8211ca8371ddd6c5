"""One constraint of the nonlinear program per file."""
