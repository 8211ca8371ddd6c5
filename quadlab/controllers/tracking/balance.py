"""Whether a leg can be spared: the capture point against the support that the other feet give."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from quadlab.geometry.polygons import distance_inside
from quadlab.geometry.rotations import Array

_FEET_OF_AN_AREA = 3
"""So many feet span an area of support."""


@dataclass(frozen=True)
class Balance:
    """Feet, and where a centre of pressure would bring the CoM to rest; in the world in [m].

    Attributes:
        feet: contact points of all feet, (4, 2).
        capture_point: of the measured motion, (2,).
        planned_capture_point: of the plan's motion, as the plan lies in the world, (2,).
    """

    feet: Array
    capture_point: Array
    planned_capture_point: Array

    def held_by(self, legs: list[int], margin: float) -> bool:
        """Return whether ``legs`` can bring the CoM to rest, or it moves as planned and needs no rest.

        Fewer than three legs span no area: a gait that stands on them is held by its next step, and nothing is asked.

        Args:
            legs: numbers of the legs that shall stand.
            margin: how far inside the support the capture point shall be, and how far from the planned one it may be,
                in [m].
        """
        if len(legs) < _FEET_OF_AN_AREA or math.dist(self.capture_point, self.planned_capture_point) <= margin:
            return True
        return distance_inside(self.capture_point, self.feet[legs]) >= margin


AskForBalance: TypeAlias = Callable[[], Balance]
"""Tells the balance of this tick."""
