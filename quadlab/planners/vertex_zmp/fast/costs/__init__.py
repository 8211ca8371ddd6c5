"""One cost of the reduced program per file, each a sum of squares of affine rows."""
