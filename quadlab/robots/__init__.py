"""What a robot is: description, model, state."""
