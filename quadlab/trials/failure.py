"""When a trial is over before its time."""

import math

from quadlab.configuration import Fraction, Positive, StrictModel
from quadlab.controllers.telemetry import ControlTelemetry
from quadlab.geometry.rotations import tilt_of
from quadlab.robots.state import RobotState


class FailureConfig(StrictModel):
    """What counts as a failed trial.

    Attributes:
        height_share: the robot has fallen if its base is lower over the ground than this share of its standing height.
        tilt_rad: it has fallen if its base is tilted further, in [rad].
        progress_share: it made no progress if it covered less than this share of the planned distance.
    """

    height_share: Fraction
    tilt_rad: Positive
    progress_share: Fraction


def fall_reason(
    config: FailureConfig, state: RobotState, telemetry: ControlTelemetry, standing_height: float
) -> str | None:
    """Return in one line why the robot counts as fallen, None if it does not.

    Args:
        config: thresholds.
        state: true state.
        telemetry: for the terrain under the robot.
        standing_height: of the base over the ground in [m].
    """
    tilt = tilt_of(state.rotation_base_to_world)
    if tilt > config.tilt_rad:
        return f"fell at {state.time_s:.2f} s: base tilted by {math.degrees(tilt):.0f} deg"
    height = float(state.position_base_in_world[2]) - float(telemetry.terrain_plane[0])
    if height < config.height_share * standing_height:
        return f"fell at {state.time_s:.2f} s: base {1e3 * height:.0f} mm over the ground"
    return None


def progress_reason(config: FailureConfig, distance: float, planned_distance: float) -> str | None:
    """Return in one line why the robot counts as stuck, None if it does not; distances in [m]."""
    if distance >= config.progress_share * planned_distance:
        return None
    return f"covered {distance:.2f} m of {planned_distance:.2f} m planned"
