"""The plan's clock: it runs down while a foot has not found the ground, and up again."""

import math
from dataclasses import dataclass


@dataclass
class PlanClock:
    """Time in the plan; its rate follows 0 or 1 with a time constant.

    With sqrt(h / g) as time constant a centre of mass of constant planned speed v comes to rest v sqrt(h / g) further
    on, by a centre of pressure that stays at its capture point: the gentlest stop.

    Attributes:
        time_constant_s: in [s].
        rate: seconds of the plan in a second.
        rate_change: time derivative of ``rate`` in [1/s].
        waited_s: how far the plan is behind the time since its start in [s].
    """

    time_constant_s: float
    rate: float = 1.0
    rate_change: float = 0.0
    waited_s: float = 0.0

    def advance(self, waits: bool, period_s: float) -> None:
        """Go on by one control period of ``period_s`` in [s], towards rest if ``waits``."""
        target = 0.0 if waits else 1.0
        self.rate = target + (self.rate - target) * math.exp(-period_s / self.time_constant_s)
        self.rate_change = (target - self.rate) / self.time_constant_s
        self.waited_s += (1.0 - self.rate) * period_s
