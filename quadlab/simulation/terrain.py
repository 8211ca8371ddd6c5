"""What the ground is made of: a level floor at z = 0 under the start, and pieces of terrain on or after it."""

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import AfterValidator, Field

from quadlab.configuration import Positive, StrictModel
from quadlab.errors import ConfigurationError
from quadlab.geometry.rotations import matrix_to_quat, rotation_zyx
from quadlab.simulation.ground import Ground, TerrainBox, ground_from, ground_until, yaw_quat

_RAMP_THICKNESS = 0.5  # [m]


def _not_level(value: float) -> float:
    if value == 0.0:
        raise ValueError("must be above or below 0; level ground needs no piece of terrain")
    return value


class PlankConfig(StrictModel):
    """A box lying on the floor.

    Attributes:
        center_x_m, center_y_m: centre in world axes in [m].
        length_m: extent along its x in [m].
        width_m: extent along its y in [m].
        height_m: in [m].
        yaw_deg: heading in [deg].
    """

    kind: Literal["plank"]
    center_x_m: float
    center_y_m: float
    length_m: Positive
    width_m: Positive
    height_m: Positive
    yaw_deg: float

    def lowest(self) -> float:
        """Return the height of the ground that the piece descends to, in [m]."""
        return 0.0

    def boxes(self, name: str, floor_height: float) -> list[TerrainBox]:
        """Return the piece's boxes; it reaches down to ``floor_height`` in [m]."""
        center = np.array([self.center_x_m, self.center_y_m, 0.5 * (self.height_m + floor_height)])
        half_size = 0.5 * np.array([self.length_m, self.width_m, self.height_m - floor_height])
        return [TerrainBox(name, center, half_size, yaw_quat(math.radians(self.yaw_deg)))]


class StepConfig(StrictModel):
    """A step across the way: from ``edge_x_m`` on, the ground lies at ``height_m``.

    Attributes:
        edge_x_m: in [m].
        height_m: positive up, negative down, not 0, in [m].
    """

    kind: Literal["step"]
    edge_x_m: float
    height_m: Annotated[float, AfterValidator(_not_level)]

    def lowest(self) -> float:
        """Return the height of the ground that the piece descends to, in [m]."""
        return min(0.0, self.height_m)

    def boxes(self, name: str, floor_height: float) -> list[TerrainBox]:
        """Return the piece's boxes; they reach down to ``floor_height`` in [m]."""
        if self.height_m < 0.0:
            return [ground_until(name, self.edge_x_m, floor_height)]
        return [ground_from(name, self.edge_x_m, self.height_m)]


class SlopeConfig(StrictModel):
    """A ramp along x that starts on the floor; level ground continues at the height where it ends.

    Attributes:
        start_x_m: where the ramp begins in [m].
        length_m: horizontal length in [m].
        angle_deg: positive up, negative down, not 0, in [deg].
        width_m: extent along y in [m].
    """

    kind: Literal["slope"]
    start_x_m: float
    length_m: Positive
    angle_deg: Annotated[float, Field(gt=-60.0, lt=60.0), AfterValidator(_not_level)]
    width_m: Positive

    def rise(self) -> float:
        """Return the height gained over the ramp in [m]."""
        return self.length_m * math.tan(math.radians(self.angle_deg))

    def lowest(self) -> float:
        """Return the height of the ground that the piece descends to, in [m]."""
        return min(0.0, self.rise())

    def boxes(self, name: str, floor_height: float) -> list[TerrainBox]:
        """Return the ramp and the level ground before or after it."""
        ramp = self._ramp(f"{name}_ramp")
        if self.rise() < 0.0:
            return [ramp, ground_until(f"{name}_start", self.start_x_m, floor_height)]
        return [ramp, ground_from(f"{name}_end", self.start_x_m + self.length_m, self.rise(), self.width_m)]

    def _ramp(self, name: str) -> TerrainBox:
        """Return a tilted box whose upper face joins both ends of the ramp."""
        angle = math.radians(self.angle_deg)
        rotation = rotation_zyx(0.0, -angle, 0.0)
        surface_middle = np.array([self.start_x_m + 0.5 * self.length_m, 0.0, 0.5 * self.rise()])
        half_size = np.array([0.5 * self.length_m / math.cos(angle), 0.5 * self.width_m, 0.5 * _RAMP_THICKNESS])
        center = surface_middle - rotation[:, 2] * half_size[2]
        return TerrainBox(name, center, half_size, matrix_to_quat(rotation))


TerrainConfig = Annotated[PlankConfig | StepConfig | SlopeConfig, Field(discriminator="kind")]


def build_ground(terrain: tuple[TerrainConfig, ...]) -> Ground:
    """Return the floor and boxes of the pieces of ``terrain``.

    Raises:
        ConfigurationError: if more than one piece descends from the start.
    """
    descending = [piece for piece in terrain if piece.lowest() < 0.0]
    if len(descending) > 1:
        kinds = ", ".join(piece.kind for piece in descending)
        raise ConfigurationError(f"terrain: at most one piece may lead below z = 0; got {len(descending)}: {kinds}")
    floor_height = descending[0].lowest() if descending else 0.0
    boxes = [box for number, piece in enumerate(terrain) for box in piece.boxes(f"terrain_{number}", floor_height)]
    return Ground(floor_height, tuple(boxes))
