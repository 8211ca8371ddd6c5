"""Limits, one a file; a limit is a task whose rows are inequalities."""
