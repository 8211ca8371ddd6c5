"""Robots, states, references and plans shared by the tests of controllers."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import pinocchio as pin
import yaml

from quadlab.constants import GRAVITY
from quadlab.controllers.hierarchical import HierarchicalResolver
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tracking.config import TrackingConfig
from quadlab.gaits.gait import GaitConfig, contact_schedule
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array, matrix_to_quat, rotation_z
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.paths import CONF_DIR
from quadlab.planners.plan import MotionPlan, PlanReport, PlanVerdict
from quadlab.robots.catalogue import robot_config
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.state import RobotState

ROBOTS = ("anymal_b", "hyq")
STANCES: tuple[list[int], ...] = ([0, 1, 2, 3], [0, 1, 3], [1, 2], [0, 3], [])
"""Standing legs: all, three, the two diagonals, none."""


@lru_cache
def robot_named(name: str) -> RobotModel:
    return load_robot(robot_config(name))


def shipped(path: str) -> Any:
    return yaml.safe_load((CONF_DIR / path).read_text())


def controller_config(**changes: Any) -> HierarchicalResolver.Config:
    return HierarchicalResolver.Config.model_validate({**shipped("controller/hierarchical.yaml"), **changes})


def tracking_config(**changes: dict[str, Any]) -> TrackingConfig:
    """The shipped tracking, with changes by section."""
    shipped_tracking = shipped("controller/hierarchical.yaml")["tracking"]
    return TrackingConfig.model_validate(
        {name: {**values, **changes.get(name, {})} for name, values in shipped_tracking.items()}
    )


def any_state(robot: RobotModel, seed: int) -> RobotState:
    """Any pose and velocity, joints around the nominal stance."""
    generator = np.random.default_rng(seed)
    quat = generator.normal(size=4)
    return replace(
        robot.nominal_state(),
        position_base_in_world=generator.normal(size=3),
        quat_wxyz=quat / np.linalg.norm(quat),
        joint_positions=robot.nominal_joint_positions + generator.uniform(-0.3, 0.3, 12),
        linear_velocity_base_in_world=generator.normal(size=3),
        angular_velocity_base_in_base=generator.normal(size=3),
        joint_velocities=generator.normal(size=12),
    )


def disturbed_state(robot: RobotModel, seed: int, size: float = 1.0) -> RobotState:
    """Near the nominal stance, as a push leaves a robot: a few centimetres, degrees and decimetres a second off."""
    generator = np.random.default_rng(seed)
    nominal = robot.nominal_state()
    rotation = pin.exp3(size * generator.uniform(-0.06, 0.06, 3))
    return replace(
        nominal,
        position_base_in_world=nominal.position_base_in_world + size * generator.uniform(-0.02, 0.02, 3),
        quat_wxyz=matrix_to_quat(rotation),
        joint_positions=robot.nominal_joint_positions + size * generator.uniform(-0.03, 0.03, 12),
        linear_velocity_base_in_world=size * generator.uniform(-0.1, 0.1, 3),
        angular_velocity_base_in_base=size * generator.uniform(-0.1, 0.1, 3),
        joint_velocities=size * generator.uniform(-0.1, 0.1, 12),
    )


def moved_state(state: RobotState, shift: Array, yaw: float) -> RobotState:
    """The same state turned about the world's vertical axis by ``yaw`` and then shifted by ``shift`` (2,)."""
    turn = rotation_z(yaw)
    return replace(
        state,
        position_base_in_world=turn @ state.position_base_in_world + np.array([*shift, 0.0]),
        quat_wxyz=matrix_to_quat(turn @ state.rotation_base_to_world),
        linear_velocity_base_in_world=turn @ state.linear_velocity_base_in_world,
        foot_forces_in_world=state.foot_forces_in_world @ turn.T,
    )


def integrated(robot: RobotModel, state: RobotState, acceleration: Array, duration: float) -> RobotState:
    """State after ``duration`` (of either sign) with the constant generalised acceleration ``acceleration`` (18,)."""
    _, velocity = robot.to_pinocchio(state)
    base_step = duration * velocity[:6] + 0.5 * duration**2 * acceleration[:6]
    base_velocity = velocity[:6] + duration * acceleration[:6]
    pose = pin.SE3(state.rotation_base_to_world, state.position_base_in_world) * pin.exp6(pin.Motion(base_step))
    joint_step = duration * state.joint_velocities + 0.5 * duration**2 * acceleration[6:]
    return replace(
        state,
        time_s=state.time_s + duration,
        position_base_in_world=pose.translation,
        quat_wxyz=matrix_to_quat(pose.rotation),
        joint_positions=state.joint_positions + joint_step,
        linear_velocity_base_in_world=pose.rotation @ base_velocity[:3],
        angular_velocity_base_in_base=base_velocity[3:],
        joint_velocities=state.joint_velocities + duration * acceleration[6:],
    )


def with_loads(robot: RobotModel, state: RobotState, loaded: Sequence[int] = (0, 1, 2, 3)) -> RobotState:
    """``state`` with the weight shared by the ``loaded`` feet."""
    forces = np.zeros((4, 3))
    forces[list(loaded), 2] = robot.mass * GRAVITY / max(len(loaded), 1)
    return replace(state, foot_forces_in_world=forces)


def reference_at(robot: RobotModel, kinematics: Kinematics, stance: Sequence[int] = (0, 1, 2, 3)) -> ControlReference:
    """The reference that the measured state meets exactly, with no acceleration asked for."""
    in_air = np.array([leg not in stance for leg in range(4)])
    feet = np.where(in_air[:, None], kinematics.foot_positions, np.nan)
    return ControlReference(
        com_position=kinematics.com_position[:2],
        com_velocity=kinematics.com_velocity[:2],
        com_acceleration=np.zeros(2),
        base_position=kinematics.base_position[:2],
        base_height=float(kinematics.base_position[2]),
        base_velocity=kinematics.base_linear_velocity,
        base_acceleration=np.zeros(3),
        base_rotation=kinematics.base_rotation,
        base_angular_velocity=kinematics.base_angular_velocity,
        base_angular_acceleration=np.zeros(3),
        foot_positions=feet,
        foot_velocities=np.where(in_air[:, None], kinematics.foot_velocities, np.nan),
        foot_accelerations=np.where(in_air[:, None], 0.0, np.nan) * np.ones(3),
        stance=~in_air,
        normal_force_limits=np.full(4, 2.0 * robot.mass * GRAVITY),
        torque_limits=robot.torque_limits,
        joint_position_limits=robot.joint_position_limits,
        weight=robot.mass * GRAVITY,
        standing_height=float(robot.nominal_state().position_base_in_world[2]),
        ground_axes=np.eye(3),
    )


def gait_schedule(gait: str, duration_s: float) -> ContactSchedule:
    return contact_schedule(GaitConfig(**shipped(f"gait/{gait}.yaml")), duration_s)


def standing_schedule(duration_s: float = 10.0) -> ContactSchedule:
    return ContactSchedule(np.array([duration_s]), np.ones((1, 4), dtype=bool))


def uniform_plan(
    robot: RobotModel,
    schedule: ContactSchedule,
    velocity: tuple[float, float] = (0.0, 0.0),
    shift: tuple[float, float] = (0.0, 0.0),
    yaw: float = 0.0,
    *,
    com_over_feet: bool = False,
) -> MotionPlan:
    """The nominal stance moving with a constant velocity along plan axes that are turned by ``yaw`` and shifted.

    Its CoM is where the robot has it, or over the middle of the feet, where both diagonals can carry it.
    """
    nominal, turn = robot.kinematics(robot.nominal_state()), rotation_z(yaw)
    offset, speed = np.array([*shift, 0.0]), turn @ np.array([*velocity, 0.0])
    com = nominal.com_position.copy()
    if com_over_feet:
        com[:2] = nominal.foot_positions[:, :2].mean(axis=0)
    com = turn @ com + offset
    feet = nominal.foot_positions @ turn.T + offset
    knots = np.array([0.0, schedule.duration_s])
    footholds = tuple(
        np.stack([foot, *(foot + swing.end_s * speed for swing in swings)])
        for foot, swings in zip(feet, schedule.swings, strict=True)
    )
    return MotionPlan(
        schedule=schedule,
        com=PiecewisePolynomial(knots, np.array([[com, speed, np.zeros(3)]])),
        heading=PiecewisePolynomial(knots, np.array([[[yaw]]])),
        cop=PiecewisePolynomial(knots, np.array([[com[:2], speed[:2]]])),
        footholds=footholds,
        report=PlanReport("uniform", 0.0, 0.0, 0, 0, 0),
        verdict=PlanVerdict({}, {}),
    )
