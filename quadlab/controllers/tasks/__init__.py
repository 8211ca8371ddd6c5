"""Motion tasks, one a file."""
