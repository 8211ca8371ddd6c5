"""What the robot believes about itself and the ground."""
