"""Reusable drawings, one concept a file; each draws into axes that it is given."""
