"""One script per table or figure of the papers; each reads results or configurations and never simulates."""
