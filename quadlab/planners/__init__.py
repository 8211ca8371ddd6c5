"""From a start, a goal and a contact schedule to a checked motion plan."""
