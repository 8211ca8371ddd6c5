"""What no paper compares: planners and controllers on the same disturbances."""
