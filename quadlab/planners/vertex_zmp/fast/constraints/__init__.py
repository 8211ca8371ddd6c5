"""One constraint of the reduced program per file."""
