"""Reads records into tables and statistics; no plotting."""
