"""Constants of nature that planning, control, estimation and evaluation share."""

GRAVITY = 9.81  # [m/s^2]
