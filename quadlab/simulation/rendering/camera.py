"""A camera that follows the robot without shaking."""

from typing import Any

import mujoco
import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.simulation.rendering.config import ViewConfig


def smoothed(values: Array, times_s: Array, smoothing_s: float) -> Array:
    """Return ``values`` averaged with a Gaussian window in time, without delay.

    Beyond its ends the curve is continued by point reflection, so that a steady walk stays steady there.

    Args:
        values: (n, d).
        times_s: (n,) evenly spaced, in [s].
        smoothing_s: standard deviation of the window in [s]; 0 returns the values.
    """
    if smoothing_s <= 0.0 or len(times_s) < 2:
        return values
    step = float(times_s[-1] - times_s[0]) / (len(times_s) - 1)
    reach = min(int(3.0 * smoothing_s / step), len(times_s) - 1)
    window = np.exp(-0.5 * (np.arange(-reach, reach + 1) * step / smoothing_s) ** 2)
    before = 2.0 * values[0] - values[1 : reach + 1][::-1]
    after = 2.0 * values[-1] - values[len(values) - 1 - reach : -1][::-1]
    padded = np.concatenate([before, values, after])
    columns = [np.convolve(column, window / window.sum(), mode="valid") for column in padded.T]
    return np.stack(columns, axis=1)


def camera_at(target: Array, heading: float, robot_size: float, view: ViewConfig) -> Any:
    """Return an ``MjvCamera`` that looks at ``target``, (3,) in [m].

    Args:
        target: where the camera looks, in world.
        heading: yaw in [rad] from which the azimuth counts.
        robot_size: in [m].
        view: where the camera stands.
    """
    camera = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    camera.lookat[:] = target
    camera.distance = view.distance_sizes * robot_size
    camera.azimuth = np.degrees(heading) + view.azimuth_deg + 180.0
    camera.elevation = -view.elevation_deg
    return camera
