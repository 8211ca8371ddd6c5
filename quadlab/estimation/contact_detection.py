"""Which feet touch the ground, from the forces under them."""

from dataclasses import dataclass, field

import numpy as np

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
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
        share = self.period_s / (self.config.time_constant_s + self.period_s)
        self._force = self._force + share * (normal_forces - self._force)
        threshold = np.where(self.touches, self.config.lift_off_share, self.config.touch_down_share)
        self.touches = self._force > threshold * self.weight
        self._touched_s = np.where(self.touches, self._touched_s + self.period_s, 0.0)
        standing: BoolArray = self._touched_s > self.config.settling_s
        return standing
