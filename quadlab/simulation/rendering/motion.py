"""What happened in a trial, as far as a picture shows it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quadlab.errors import LogError
from quadlab.geometry.rotations import Array
from quadlab.robots.legs import JOINT_COUNT, LEG_COUNT


@dataclass(frozen=True)
class Motion:
    """The recorded motion of a robot at n increasing times.

    Attributes:
        times_s: (n,) in [s].
        positions_base_in_world: (n, 3) in [m].
        quats_wxyz: base to world, (n, 4).
        joint_positions: (n, 12) in [rad], order ``JOINT_NAMES``.
        foot_forces_in_world: force of the ground on each foot, (n, 4, 3) in [N]; None if not recorded.
        com_reference_in_world: (k, 3) in [m], the line the centre of mass was asked to follow; None if not recorded.
    """

    times_s: Array
    positions_base_in_world: Array
    quats_wxyz: Array
    joint_positions: Array
    foot_forces_in_world: Array | None = None
    com_reference_in_world: Array | None = None

    def __post_init__(self) -> None:
        """Check the shapes.

        Raises:
            LogError: if an array has not the expected shape, or times do not increase.
        """
        n = len(self.times_s)
        expected = {
            "times_s": (n,),
            "positions_base_in_world": (n, 3),
            "quats_wxyz": (n, 4),
            "joint_positions": (n, JOINT_COUNT),
        }
        if self.foot_forces_in_world is not None:
            expected["foot_forces_in_world"] = (n, LEG_COUNT, 3)
        for name, shape in expected.items():
            if np.shape(getattr(self, name)) != shape:
                raise LogError(f"{name}: expected shape {shape}, found {np.shape(getattr(self, name))}")
        if n == 0 or bool(np.any(np.diff(self.times_s) <= 0.0)):
            raise LogError("times_s: expected at least one time, and each later than the one before")

    @cached_property
    def _continuous_quats(self) -> Array:
        """Quaternions with signs such that neighbours are close, (n, 4)."""
        products = np.sum(self.quats_wxyz[1:] * self.quats_wxyz[:-1], axis=1)
        signs = np.cumprod(np.concatenate([[1.0], np.where(products < 0.0, -1.0, 1.0)]))
        return self.quats_wxyz * signs[:, None]

    @property
    def span(self) -> tuple[float, float]:
        """First and last time in [s]."""
        return float(self.times_s[0]), float(self.times_s[-1])

    def at(self, times_s: Array) -> "Motion":
        """Return the motion at other times, linear between samples, at rest outside the recorded span."""
        quats = self._interpolated(times_s, self._continuous_quats)
        forces = self.foot_forces_in_world
        return Motion(
            np.asarray(times_s, float),
            self._interpolated(times_s, self.positions_base_in_world),
            quats / np.linalg.norm(quats, axis=1, keepdims=True),
            self._interpolated(times_s, self.joint_positions),
            None if forces is None else self._interpolated(times_s, forces),
            self.com_reference_in_world,
        )

    def _interpolated(self, times_s: Array, values: Array) -> Array:
        flat = values.reshape(len(self.times_s), -1)
        columns = [np.interp(times_s, self.times_s, column) for column in flat.T]
        return np.stack(columns, axis=1).reshape(len(times_s), *values.shape[1:])
