"""The planning problem of a trial: where the robot stands, what was commanded, which schedule holds."""

from typing import Any

import numpy as np

from quadlab.configuration import part_of
from quadlab.gaits.gait import contact_schedule, stride_times
from quadlab.geometry.rotations import yaw_of
from quadlab.planners.command import waypoints
from quadlab.planners.planner import Planner
from quadlab.planners.problem import PlanningModel, PlanningProblem, PlanStart
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState
from quadlab.trials.config import TrialConfig


def planning_model(robot: RobotModel) -> PlanningModel:
    """Return the robot as planners see it, from its nominal stance."""
    return PlanningModel(
        com_height=robot.nominal_com_height,
        nominal_feet=robot.nominal_feet_in_com,
        reach=robot.reach,
    )


def plan_start(robot: RobotModel, state: RobotState) -> PlanStart:
    """Return where a plan begins: the plan frame is the world, lowered to the mean height of the feet."""
    kinematics = robot.kinematics(state)
    feet = kinematics.foot_positions.copy()
    feet[:, 2] = 0.0
    return PlanStart(
        com_position=kinematics.com_position[:2],
        com_velocity=kinematics.com_velocity[:2],
        yaw=yaw_of(kinematics.base_rotation),
        feet=feet,
        state=state,
    )


def planning_problem(config: TrialConfig, robot: RobotModel, state: RobotState) -> PlanningProblem:
    """Return the problem that a planner is given at the start of the trial."""
    start = plan_start(robot, state)
    pose = np.array([*start.com_position, start.yaw])
    times = stride_times(config.gait, config.duration_s)
    return PlanningProblem(
        start=start,
        waypoints=waypoints(config.command, times, pose, config.duration_s),
        schedule=contact_schedule(config.gait, config.duration_s),
        model=planning_model(robot),
        robot=robot,
    )


def build_planner(config: TrialConfig) -> Planner:
    """Return the configured planner."""
    planner_type: Any = part_of("planner", config.planner)
    planner: Planner = planner_type(config.planner)
    return planner
