"""Which feet touch the ground, from the forces under them."""

from dataclasses import dataclass, field
from typing import Self

import numpy as np
from pydantic import model_validator

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry
from quadlab.robots.legs import LEG_COUNT


class ContactDetectionConfig(StrictModel):
    """Thresholds of the normal force, as shares of the robot's weight.

    Attributes:
        touch_down_share: more force starts a contact.
        lift_off_share: less force ends it.
        settling_s: how long the force must last before the foot counts as standing still in [s].
        time_constant_s: of the filter that smooths the normal force in [s]; 0 for none.
    """

    touch_down_share: Positive
    lift_off_share: Positive
    settling_s: NonNegative
    time_constant_s: NonNegative

    @model_validator(mode="after")
    def _contact_ends_below_where_it_starts(self) -> Self:
        if self.lift_off_share > self.touch_down_share:
            raise ValueError(
                f"lift_off_share must not be above touch_down_share; are {self.lift_off_share:g} and "
                f"{self.touch_down_share:g}"
            )
        return self


@dataclass
class ContactDetector:
    """A Schmitt trigger for each foot; a foot that has just landed settles before it counts.

    Attributes:
        config: thresholds.
        weight: of the robot in [N].
        period_s: time between updates in [s].
        touches: feet that feel the ground, (4,); those that have just landed have not settled yet.
    """

    config: ContactDetectionConfig
    weight: float
    period_s: float
    touches: BoolArray = field(default_factory=lambda: np.zeros(LEG_COUNT, dtype=bool))
    _force: Array = field(default_factory=lambda: np.zeros(LEG_COUNT))
    _touched_s: Array = field(default_factory=lambda: np.zeros(LEG_COUNT))

    def update(self, normal_forces: Array) -> BoolArray:
        """Return which feet stand, (4,), after one more period with ``normal_forces``, (4,) in [N]."""
        config = self.config
        self._force, self.touches, self._touched_s = _sense(
            self._force + self._share * (normal_forces - self._force),
            self.touches,
            self._touched_s,
            self.period_s,
            (config.touch_down_share * self.weight, config.lift_off_share * self.weight),
        )
        standing: BoolArray = self._touched_s > config.settling_s
        return standing

    @property
    def _share(self) -> float:
        """Of a change of the force that passes the filter in one period."""
        return self.period_s / (self.config.time_constant_s + self.period_s)


@compiled_entry
def _sense(
    forces: Array, touches: BoolArray, touched_s: Array, period_s: float, thresholds: tuple[float, float]
) -> tuple[Array, BoolArray, Array]:
    """Return forces, contacts and how long they have lasted in [s], (4,) each.

    Args:
        forces: filtered normal forces, (4,) in [N].
        touches, touched_s: contacts and their duration before, (4,).
        period_s: time since then in [s].
        thresholds: forces that start and that keep a contact in [N].
    """
    now, lasted = np.empty_like(touches), np.zeros_like(touched_s)
    for leg in range(len(forces)):
        now[leg] = forces[leg] > (thresholds[1] if touches[leg] else thresholds[0])
        if now[leg]:
            lasted[leg] = touched_s[leg] + period_s
    return forces, now, lasted
