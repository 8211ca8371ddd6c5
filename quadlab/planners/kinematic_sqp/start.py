"""The first sample: the measured state in the planner's coordinates."""

from dataclasses import dataclass

import numpy as np

from quadlab.errors import PlanningProblemError
from quadlab.geometry.rotations import Array, euler_zyx, wrap_angle
from quadlab.planners.kinematic_sqp.kinematics import SampleKinematics
from quadlab.planners.problem import PlanningProblem
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState

_AGREEMENT = 1e-6  # [m], [rad] between the two descriptions of the start
_STEEPEST_PITCH = 1.4  # [rad] beyond it yaw and roll are not defined


@dataclass(frozen=True)
class StartSample:
    """The measured state in the plan frame.

    Attributes:
        positions: blocks base_position, base_rotation, joints and com of the first sample.
        velocities: of base_position, base_rotation and com, (3,) each per second.
        feet: contact points, (4, 3) in [m].
    """

    positions: dict[str, Array]
    velocities: dict[str, Array]
    feet: Array


def robot_and_state(problem: PlanningProblem) -> tuple[RobotModel, RobotState]:
    """Return what a planner that moves joints needs beside the point mass.

    Raises:
        PlanningProblemError: if one of them is missing or the state is not finite.
    """
    robot, state = problem.robot, problem.start.state
    if robot is None or state is None:
        missing = "problem.robot" if robot is None else "problem.start.state"
        raise PlanningProblemError(f"{missing}: None; kinematic_sqp moves joints and needs the robot and its state")
    if not state.is_finite():
        raise PlanningProblemError("start.state: holds NaN or infinity")
    return robot, state


def start_sample(problem: PlanningProblem, kinematics: SampleKinematics) -> StartSample:
    """Return the first sample; the ground is at the mean height of the feet.

    Raises:
        PlanningProblemError: if the state is missing, lies on its side, or contradicts the start of the problem.
    """
    robot, state = robot_and_state(problem)
    rotation = np.array(euler_zyx(state.rotation_base_to_world))
    if abs(rotation[1]) > _STEEPEST_PITCH:
        raise PlanningProblemError(f"start.state: pitch {rotation[1]:.2f} rad, expected at most {_STEEPEST_PITCH} rad")
    rotation[0] = problem.start.yaw + wrap_angle(float(rotation[0]) - problem.start.yaw)
    pose = np.concatenate([state.position_base_in_world, rotation, state.joint_positions])
    com, feet = (values[0] for values in kinematics.positions(pose[None]))
    ground = np.array([0.0, 0.0, float(feet[:, 2].mean())])
    _require_agreement(problem, com, feet, float(rotation[0]))
    return StartSample(
        positions={
            "base_position": state.position_base_in_world - ground,
            "base_rotation": rotation,
            "joints": state.joint_positions,
            "com": com - ground,
        },
        velocities={
            "base_position": state.linear_velocity_base_in_world,
            "base_rotation": _euler_rates(rotation, state.angular_velocity_base_in_base),
            "com": robot.kinematics(state).com_velocity,
        },
        feet=feet - ground,
    )


def _require_agreement(problem: PlanningProblem, com: Array, feet: Array, yaw: float) -> None:
    start = problem.start
    differences = {
        "com_position": float(np.abs(start.com_position - com[:2]).max()),
        "feet": float(np.abs(start.feet[:, :2] - feet[:, :2]).max()),
        "yaw": abs(start.yaw - yaw),
    }
    for name, difference in differences.items():
        if difference > _AGREEMENT:
            raise PlanningProblemError(f"start.{name}: differs from start.state by {difference:.3g}, expected the same")


def _euler_rates(rotation: Array, angular_velocity_in_base: Array) -> Array:
    """Return d(yaw, pitch, roll)/dt, (3,), of an angular velocity in base components."""
    _, pitch, roll = rotation
    _, about_y, about_z = angular_velocity_in_base
    yaw_rate = (np.sin(roll) * about_y + np.cos(roll) * about_z) / np.cos(pitch)
    pitch_rate = np.cos(roll) * about_y - np.sin(roll) * about_z
    return np.array([yaw_rate, pitch_rate, angular_velocity_in_base[0] + np.sin(pitch) * yaw_rate])
