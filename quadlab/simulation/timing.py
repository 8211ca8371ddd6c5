"""Whole numbers of simulation steps."""

from quadlab.errors import ConfigurationError

_TOLERANCE = 1e-6
"""Of a ratio of two periods: decimal periods are not exact in binary."""


def check_period(period_s: float, timestep_s: float) -> int:
    """Return how many steps of ``timestep_s`` make up ``period_s``, both in [s].

    Raises:
        ConfigurationError: if that is not a whole, positive number.
    """
    ratio = period_s / timestep_s
    steps = round(ratio)
    if steps < 1 or abs(ratio - steps) > _TOLERANCE * max(1.0, ratio):
        nearest = max(1, steps) * timestep_s
        raise ConfigurationError(
            f"a period of {period_s:g} s is not a whole multiple of the simulation's timestep of {timestep_s:g} s "
            f"({ratio:.6g} steps); the nearest is {nearest:g} s"
        )
    return steps
