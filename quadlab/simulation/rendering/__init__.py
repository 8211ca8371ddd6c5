"""Pictures and videos of a trial, drawn from its log without a display."""
