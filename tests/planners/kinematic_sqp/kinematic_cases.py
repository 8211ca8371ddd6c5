"""Robots, motions and problems shared by the tests of the kinematic planner."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from quadlab.gaits.gait import GaitConfig, contact_schedule, stride_times
from quadlab.geometry.rotations import Array, matrix_to_quat, rotation_zyx, yaw_of
from quadlab.planners.command import PerStrideCommand, waypoints
from quadlab.planners.kinematic_sqp.planner import KinematicSqpBuild, KinematicSqpPlanner
from quadlab.planners.kinematic_sqp.sqp import Minimum, minimise
from quadlab.planners.problem import PlanningModel, PlanningProblem, PlanStart
from quadlab.robots.catalogue import robot_config
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.state import RobotState

CONF = Path(__file__).parents[3] / "conf"
ROBOTS = ("anymal_b", "hyq")


@dataclass(frozen=True)
class Motion:
    """Cycles of named gaits with their stride durations in [s], commanded x, y in [m] and turn in [deg] a stride."""

    gaits: tuple[str, ...]
    strides_s: tuple[float, ...]
    command: tuple[float, float, float]
    rest_s: float = 0.0


PAPER_MOTIONS = {
    "walk": Motion(("walk", "walk"), (5.0, 5.0), (0.2, 0.0, 0.0)),
    "trot": Motion(("trot", "trot"), (0.8, 0.8), (0.15, 0.0, 0.0)),
    "transition": Motion(("walk", "trot"), (4.0, 0.8), (0.2, 0.0, 0.0)),
    "turning_trot": Motion(("trot", "trot"), (0.8, 0.8), (0.0, 0.0, 20.0)),
    "turning_walk": Motion(("walk", "walk"), (5.0, 5.0), (0.0, 0.0, 20.0)),
    "sideways_trot": Motion(("trot", "trot"), (0.8, 0.8), (0.0, 0.1, 0.0)),
    "sideways_walk": Motion(("walk", "walk"), (5.0, 5.0), (0.0, 0.1, 0.0)),
}
"""Two cycles without standing, as in the paper: the second one is periodic."""

WHOLE_MOTIONS = {
    "walk": Motion(("walk",) * 4, (5.0,) * 4, (0.2, 0.0, 0.0), 1.0),
    "trot": Motion(("trot",) * 6, (0.8,) * 6, (0.2, 0.0, 0.0), 0.6),
    "turn": Motion(("trot",) * 6, (0.8,) * 6, (0.1, 0.0, 20.0), 0.6),
    "sideways": Motion(("walk",) * 4, (5.0,) * 4, (0.0, 0.1, 0.0), 1.0),
    "transition": Motion(("walk", *("trot",) * 4), (4.0, *(0.8,) * 4), (0.2, 0.0, 0.0), 1.0),
}
"""From standing to standing."""


def load(path: str) -> Any:
    return yaml.safe_load((CONF / path).read_text())


@lru_cache
def robot(name: str) -> RobotModel:
    return load_robot(robot_config(name))


def gait(names: Sequence[str], strides_s: Sequence[float], rest_s: float) -> GaitConfig:
    cycles = [
        {"stride_duration_s": duration, "strides": 1, "pattern": load(f"gait/{name}.yaml")["cycles"][0]["pattern"]}
        for name, duration in zip(names, strides_s, strict=True)
    ]
    document = {"name": "+".join(names), "initial_stance_s": rest_s, "final_stance_s": rest_s, "cycles": cycles}
    return GaitConfig.model_validate(document)


def start_of(model: RobotModel, state: RobotState) -> PlanStart:
    kinematics = model.kinematics(state)
    feet = kinematics.foot_positions.copy()
    feet[:, 2] = 0.0
    yaw = yaw_of(kinematics.base_rotation)
    return PlanStart(kinematics.com_position[:2], kinematics.com_velocity[:2], yaw, feet, state)


def problem(robot_name: str, motion: Motion, state: RobotState | None = None) -> PlanningProblem:
    model = robot(robot_name)
    start = start_of(model, state or model.nominal_state())
    x_m, y_m, yaw_deg = motion.command
    command = PerStrideCommand(kind="per_stride", x_m=x_m, y_m=y_m, yaw_deg=yaw_deg)
    config = gait(motion.gaits, motion.strides_s, motion.rest_s)
    duration_s = sum(motion.strides_s) + 2.0 * motion.rest_s
    pose = np.array([*start.com_position, start.yaw])
    return PlanningProblem(
        start=start,
        waypoints=waypoints(command, stride_times(config, duration_s), pose, duration_s),
        schedule=contact_schedule(config, duration_s),
        model=PlanningModel(model.nominal_com_height, model.nominal_feet_in_com, model.reach),
        robot=model,
    )


def beside_path(asked: PlanningProblem, offset: Array) -> PlanningProblem:
    """Return a problem whose path is moved by ``offset``, x, y in [m] and yaw in [rad], except where the robot is.

    So is a problem of planning again in the first stance, after a push.
    """
    poses = asked.waypoints.poses + offset
    poses[0] = asked.waypoints.poses[0]
    return replace(asked, waypoints=replace(asked.waypoints, poses=poses))


def perturbed(model: RobotModel, random: np.random.Generator, scale: float = 1.0) -> RobotState:
    """Return a stance with another pose, other joints and a small velocity."""
    state = model.nominal_state()
    roll, pitch, yaw = scale * random.uniform(-1.0, 1.0, 3) * np.array([0.05, 0.05, 0.5])
    return replace(
        state,
        position_base_in_world=state.position_base_in_world + scale * random.uniform(-0.02, 0.02, 3),
        quat_wxyz=matrix_to_quat(rotation_zyx(yaw, pitch, roll)),
        joint_positions=state.joint_positions + scale * random.uniform(-0.05, 0.05, 12),
        linear_velocity_base_in_world=scale * random.uniform(-0.05, 0.05, 3),
    )


def planner(**changes: Any) -> KinematicSqpPlanner:
    document = load("planner/kinematic_sqp.yaml")
    document["sqp"] |= changes.pop("sqp", {})
    return KinematicSqpPlanner(KinematicSqpPlanner.Config.model_validate({**document, **changes}))


@lru_cache
def paper_minimum(robot_name: str, name: str) -> tuple[KinematicSqpBuild, Minimum]:
    kinematic = planner()
    build = kinematic.build(problem(robot_name, PAPER_MOTIONS[name]))
    return build, minimise(build.program, kinematic.config.sqp)


def mirrored(points: Array) -> Array:
    """Return points (..., 4, 2) of legs reflected at the x axis, left and right exchanged."""
    reflected: Array = points[..., [1, 0, 3, 2], :] * np.array([1.0, -1.0])
    return reflected
