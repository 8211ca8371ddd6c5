"""Style and axes that figures share."""
