"""The plan begins in the measured pose (Gehring 2017, Section IV), CoM and heading with the measured velocity."""

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.start import StartSample
from quadlab.planners.kinematic_sqp.term import Equality, fix

_MOVING = ("base_position", "base_rotation", "com")  # blocks whose second sample follows from the velocity


def start_pose(layout: SampleLayout, start: StartSample) -> Equality:
    """Return the first sample: configuration, CoM and feet as measured."""
    values: dict[str, Array] = {**start.positions, "feet": start.feet[:, :2].ravel()}
    targets = np.concatenate([layout.indices(block)[0] for block in values])
    return fix("start_pose_m", targets, np.concatenate(list(values.values())))


def start_velocity(layout: SampleLayout, start: StartSample, period_s: float) -> Equality:
    """Return the second sample of base and CoM: first sample + period x velocity.

    The curves of CoM and heading through the samples then have the measured position and velocity at their start, with
    no acceleration. That of the base's pose, which passes through the same samples, begins at rest whatever the
    velocity (``quadlab/geometry/pose_curve.py``). The paper constrains the pose alone; a
    CoM that keeps its velocity is what the real robot can follow.

    Args:
        layout: of p.
        start: the measured state.
        period_s: between first and second sample in [s].
    """
    targets = np.concatenate([layout.indices(block)[1] for block in _MOVING])
    values = [start.positions[block] + period_s * start.velocities[block] for block in _MOVING]
    return fix("start_velocity_m", targets, np.concatenate(values))
