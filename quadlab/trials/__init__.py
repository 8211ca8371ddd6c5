"""One trial: configuration, closed loop, record, outcome."""
