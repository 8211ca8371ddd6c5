"""What the ground is made of: a level floor at z = 0 under the start, and pieces of terrain on or after it."""

import math
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from quadlab.configuration import Positive, StrictModel
from quadlab.errors import ConfigurationError
from quadlab.geometry.rotations import Array, matrix_to_quat, rotation_zyx

_GROUND_LENGTH = 40.0  # [m]
_GROUND_WIDTH = 40.0  # [m]
_MINIMUM_THICKNESS = 0.5  # [m]


@dataclass(frozen=True)
class TerrainBox:
    """A solid box of the terrain.

    Attributes:
        name: unique within the terrain.
        center: in world axes, (3,) in [m].
        half_size: half edge lengths, (3,) in [m].
        quat_wxyz: box to world, (4,).
    """

    name: str
    center: Array
    half_size: Array
    quat_wxyz: Array


@dataclass(frozen=True)
class Ground:
    """The whole terrain: an infinite floor and boxes.

    Attributes:
        floor_height: z of the infinite floor in [m]; below zero where terrain descends from the start.
        boxes: solid boxes.
    """

    floor_height: float
    boxes: tuple[TerrainBox, ...]


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
        return [TerrainBox(name, center, half_size, _heading(math.radians(self.yaw_deg)))]


class StepConfig(StrictModel):
    """A step across the way: from ``edge_x_m`` on, the ground lies at ``height_m``.

    Attributes:
        edge_x_m: in [m].
        height_m: positive up, negative down, in [m].
    """

    kind: Literal["step"]
    edge_x_m: float
    height_m: float

    def lowest(self) -> float:
        """Return the height of the ground that the piece descends to, in [m]."""
        return min(0.0, self.height_m)

    def boxes(self, name: str, floor_height: float) -> list[TerrainBox]:
        """Return the piece's boxes; they reach down to ``floor_height`` in [m]."""
        if self.height_m < 0.0:
            return [_ground_until(name, self.edge_x_m, floor_height)]
        return [_ground_from(name, self.edge_x_m, self.height_m)]


class SlopeConfig(StrictModel):
    """A ramp along x that starts on the floor; level ground continues at the height where it ends.

    Attributes:
        start_x_m: where the ramp begins in [m].
        length_m: horizontal length in [m].
        angle_deg: positive up, negative down, in [deg].
        width_m: extent along y in [m].
    """

    kind: Literal["slope"]
    start_x_m: float
    length_m: Positive
    angle_deg: Annotated[float, Field(gt=-60.0, lt=60.0)]
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
            return [ramp, _ground_until(f"{name}_start", self.start_x_m, floor_height)]
        return [ramp, _ground_from(f"{name}_end", self.start_x_m + self.length_m, self.rise(), self.width_m)]

    def _ramp(self, name: str) -> TerrainBox:
        """Return a tilted box whose upper face joins both ends of the ramp."""
        angle = math.radians(self.angle_deg)
        rotation = rotation_zyx(0.0, -angle, 0.0)
        surface_middle = np.array([self.start_x_m + 0.5 * self.length_m, 0.0, 0.5 * self.rise()])
        half_size = np.array([0.5 * self.length_m / math.cos(angle), 0.5 * self.width_m, 0.5 * _MINIMUM_THICKNESS])
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


def _heading(yaw: float) -> Array:
    return np.array([math.cos(0.5 * yaw), 0.0, 0.0, math.sin(0.5 * yaw)])


def _ground_until(name: str, edge: float, floor_height: float) -> TerrainBox:
    """Return raised ground from far behind to x = ``edge``, from z = 0 down to the floor."""
    center = np.array([edge - 0.5 * _GROUND_LENGTH, 0.0, 0.5 * floor_height])
    return TerrainBox(name, center, 0.5 * np.array([_GROUND_LENGTH, _GROUND_WIDTH, -floor_height]), _heading(0.0))


def _ground_from(name: str, edge: float, height: float, width: float = _GROUND_WIDTH) -> TerrainBox:
    """Return raised ground from x = ``edge`` onwards, from ``height`` down to z = 0."""
    center = np.array([edge + 0.5 * _GROUND_LENGTH, 0.0, 0.5 * height])
    return TerrainBox(name, center, 0.5 * np.array([_GROUND_LENGTH, width, height]), _heading(0.0))
