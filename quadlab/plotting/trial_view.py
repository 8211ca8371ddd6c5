"""What the figures of a trial need, from its log alone."""

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from quadlab.analysis.log_reader import read_log
from quadlab.analysis.trial_directory import find_log
from quadlab.analysis.trial_log import TrialLog
from quadlab.errors import LogError
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan
from quadlab.plotting.axes.contact_bands import ContactBands, recorded_bands
from quadlab.plotting.axes.pushes import RecordedPush, recorded_pushes
from quadlab.robots.config import RobotConfig, joint_names_in_urdf
from quadlab.simulation.ground import Ground
from quadlab.simulation.terrain import TerrainConfig, build_ground
from quadlab.trials.recording.topics import CONFIG_ATTACHMENT, LOG_FILE, URDF_ATTACHMENT
from quadlab.trials.result import RESULT_FILE, TrialResult, read_result
from quadlab.yaml_text import load_yaml


@dataclass(frozen=True)
class TrialView:
    """A recorded trial.

    Attributes:
        log: its tables.
        plan: that it followed.
        config: its configuration as plain data.
        ground: that it walked on.
        torque_limits: (12,) in [N m].
        foot_radius: in [m].
        period_s: control period in [s].
        result: its outcome, if it has finished.
    """

    log: TrialLog
    plan: MotionPlan
    config: dict[str, Any]
    ground: Ground
    torque_limits: Array
    foot_radius: float
    period_s: float
    result: TrialResult | None

    @cached_property
    def times_s(self) -> Array:
        """Time of each tick, (n,) in [s]."""
        return self.log.control.index.to_numpy(float)

    @property
    def end_s(self) -> float:
        """End of the last tick in [s]."""
        return float(self.times_s[-1]) + self.period_s

    @cached_property
    def bands(self) -> ContactBands:
        """Stance, planned and actual."""
        return recorded_bands(self.log, self.end_s)

    @cached_property
    def pushes(self) -> tuple[RecordedPush, ...]:
        """Pushes in order of time."""
        return recorded_pushes(self.log, self.end_s)


def load_trial_view(directory: Path) -> TrialView:
    """Return the trial recorded in ``directory``.

    Raises:
        LogError: if there is no log, or it is damaged, empty or without the attachments that a trial writes.
    """
    log = read_log(find_log(directory))
    if log.control.empty:
        raise LogError(f"{directory / LOG_FILE}: no tick was recorded, there is nothing to draw")
    config = load_yaml(log.attachment(CONFIG_ATTACHMENT))
    try:
        robot = RobotConfig.model_validate(config["robot"])
        terrain = TypeAdapter(tuple[TerrainConfig, ...]).validate_python(config["scenario"]["terrain"])
        period_s = 1.0 / float(config["controller"]["rate_hz"])
    except (KeyError, TypeError, ValidationError) as error:
        reason = str(error).splitlines()[0]
        raise LogError(
            f"{directory / LOG_FILE}: its {CONFIG_ATTACHMENT} does not describe a trial ({reason})"
        ) from error
    return TrialView(
        log=log,
        plan=log.plan,
        config=config,
        ground=build_ground(terrain),
        torque_limits=_torque_limits(log.attachment(URDF_ATTACHMENT), robot),
        foot_radius=robot.foot_radius_m,
        period_s=period_s,
        result=read_result(directory) if (directory / RESULT_FILE).is_file() else None,
    )


def _torque_limits(urdf: bytes, robot: RobotConfig) -> Array:
    """Return the limits in the order of ``JOINT_NAMES``, (12,) in [N m]."""
    limits = {joint.get("name"): joint.find("limit") for joint in ET.fromstring(urdf).findall("joint")}
    efforts = {name: limit.get("effort") for name, limit in limits.items() if limit is not None}
    names = joint_names_in_urdf(robot)
    missing = [name for name in names if efforts.get(name) is None]
    if missing:
        raise LogError(f"{URDF_ATTACHMENT}: joints without a torque limit: {', '.join(missing)}")
    return np.array([float(efforts[name] or 0.0) for name in names])
