"""When feet touch the ground."""
