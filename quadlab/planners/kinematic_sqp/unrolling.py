"""From each cycle once to the whole motion: periodic cycles repeat, moved on by what one run moves."""

from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array, rotation_2d
from quadlab.planners.kinematic_sqp.grid import SampleGrid
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.robots.pinocchio_model import IndexArray


@dataclass(frozen=True)
class PlanarMotion:
    """A displacement of the plane: x -> R(yaw) x + translation.

    Attributes:
        yaw: in [rad], not wrapped.
        translation: (2,) in [m].
    """

    yaw: float
    translation: Array

    def after(self, first: "PlanarMotion") -> "PlanarMotion":
        """Return the motion that applies ``first``, then this one."""
        return PlanarMotion(self.yaw + first.yaw, self.points(first.translation))

    def points(self, points: Array) -> Array:
        """Return moved points, (..., 2)."""
        moved: Array = points @ rotation_2d(self.yaw).T + self.translation
        return moved


@dataclass(frozen=True)
class UnrolledMotion:
    """All samples of the motion in order of time.

    Attributes:
        times_s: (M,) in [s].
        com: (M, 3) in [m].
        base_positions: (M, 3) in [m].
        base_rotations: yaw, pitch, roll, (M, 3) in [rad]; the yaw is not wrapped.
        feet: over the ground, (M, 4, 2) in [m].
    """

    times_s: Array
    com: Array
    base_positions: Array
    base_rotations: Array
    feet: Array


def unroll(layout: SampleLayout, grid: SampleGrid, p: Array) -> UnrolledMotion:
    """Return the whole motion.

    A run of a periodic cycle begins where the run before ended: with the planar motion T that takes the base from its
    pose at the first to that at the last sample of the cycle, run r is the first one moved by T^(r-1).
    """
    samples, motions = [0], [PlanarMotion(0.0, np.zeros(2))]
    moved = motions[0]
    for span in grid.spans:
        once = _cycle_motion(layout, p, span.first, span.last)
        for run in range(span.cycle.repeats):
            moved = moved.after(once) if run else moved
            numbers = range(span.first + 1, span.last + 1)
            samples += numbers
            motions += [moved] * len(numbers)
    return _moved(layout, p, grid.unrolled_times_s, np.array(samples, dtype=np.intp), motions)


def _cycle_motion(layout: SampleLayout, p: Array, first: int, last: int) -> PlanarMotion:
    """Return the planar motion of the base from one sample to another."""
    positions, yaw = layout.value("base_position", p)[:, :2], layout.value("base_rotation", p)[:, 0]
    turn = float(yaw[last] - yaw[first])
    return PlanarMotion(turn, positions[last] - rotation_2d(turn) @ positions[first])


def _moved(
    layout: SampleLayout, p: Array, times_s: Array, samples: IndexArray, motions: list[PlanarMotion]
) -> UnrolledMotion:
    def spatial(name: str) -> Array:
        points = layout.value(name, p)[samples]
        planar = [motion.points(point[:2]) for motion, point in zip(motions, points, strict=True)]
        return np.column_stack([np.array(planar), points[:, 2]])

    rotations = layout.value("base_rotation", p)[samples]
    rotations[:, 0] += [motion.yaw for motion in motions]
    feet = [motion.points(points) for motion, points in zip(motions, layout.feet(p)[samples], strict=True)]
    return UnrolledMotion(
        times_s=times_s,
        com=spatial("com"),
        base_positions=spatial("base_position"),
        base_rotations=rotations,
        feet=np.array(feet),
    )
