"""From words to letters: a planning problem as the program of the paper."""

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.config import KinematicSqpConfig
from quadlab.planners.kinematic_sqp.constraints.grounded_feet import grounded_feet
from quadlab.planners.kinematic_sqp.constraints.joint_limits import joint_limits
from quadlab.planners.kinematic_sqp.constraints.joint_speed import joint_speed
from quadlab.planners.kinematic_sqp.constraints.load_shares import load_range, load_sum, unloaded_feet
from quadlab.planners.kinematic_sqp.constraints.periodic_joints import periodic_joints
from quadlab.planners.kinematic_sqp.constraints.rest_at_end import rest_at_end
from quadlab.planners.kinematic_sqp.constraints.start_state import start_pose, start_velocity
from quadlab.planners.kinematic_sqp.elimination import eliminate
from quadlab.planners.kinematic_sqp.grid import SampleGrid, sample_grid
from quadlab.planners.kinematic_sqp.kinematics import SampleKinematics
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.objectives.com_consistency import com_consistency
from quadlab.planners.kinematic_sqp.objectives.dynamic_stability import dynamic_stability
from quadlab.planners.kinematic_sqp.objectives.feet_consistency import feet_consistency
from quadlab.planners.kinematic_sqp.objectives.regulariser import even_loads, nominal_stance
from quadlab.planners.kinematic_sqp.objectives.smoothness import smoothness
from quadlab.planners.kinematic_sqp.objectives.travel_distance import travel_distance
from quadlab.planners.kinematic_sqp.objectives.turning_angle import turning_angle
from quadlab.planners.kinematic_sqp.program import KinematicProgram
from quadlab.planners.kinematic_sqp.start import StartSample, robot_and_state, start_sample
from quadlab.planners.kinematic_sqp.strides import cycle_chain
from quadlab.planners.kinematic_sqp.term import BlockTerm, Equality, Inequality, LinearTerm
from quadlab.planners.problem import PlanningProblem
from quadlab.robots.model import RobotModel


def transcribe(problem: PlanningProblem, config: KinematicSqpConfig) -> KinematicProgram:
    """Return the program of a well-formed problem.

    Raises:
        PlanningProblemError: if the problem lacks the robot or its state, or they contradict it.
    """
    robot, _ = robot_and_state(problem)
    kinematics = SampleKinematics(robot)
    start = start_sample(problem, kinematics)
    cycles = cycle_chain(problem, config.samples_per_cycle, config.samples_per_rest)
    grid = sample_grid(cycles, problem.start.yaw)
    layout = SampleLayout(grid.samples)
    equalities = _equalities(layout, grid, start)
    return KinematicProgram(
        layout=layout,
        grid=grid,
        kinematics=kinematics,
        linear_terms=_linear_terms(layout, grid, robot, config),
        block_terms=_block_terms(layout, grid, start, problem.model.gravity, config),
        equalities=equalities,
        inequalities=_inequalities(layout, grid, robot, config),
        elimination=eliminate(equalities, layout.size),
        guess=standing_guess(layout, grid, start, robot.joint_position_limits),
        damping=config.sqp.damping,
    )


def standing_guess(layout: SampleLayout, grid: SampleGrid, start: StartSample, limits: Array) -> Array:
    """Return the start pose, within the joint limits, at every sample with equal loads."""
    p = np.zeros(layout.size)
    for block, value in {**start.positions, "feet": start.feet[:, :2].ravel()}.items():
        p[layout.indices(block)] = value
    joints = layout.indices("joints")
    p[joints] = np.clip(p[joints], limits[:, 0], limits[:, 1])
    p[layout.indices("loads")] = grid.support / grid.support.sum(axis=1, keepdims=True)
    return p


def _block_terms(
    layout: SampleLayout, grid: SampleGrid, start: StartSample, gravity: float, config: KinematicSqpConfig
) -> list[BlockTerm]:
    weights = config.weights
    heights = grid.foot_heights(config.clearance_m)
    heights[0] = start.feet[:, 2]  # measured; the plan's ground is level from the next sample on
    return [
        com_consistency(layout, weights.com_consistency),
        feet_consistency(layout, heights, weights.feet_consistency),
        dynamic_stability(layout, grid, gravity, weights.dynamic_stability),
    ]


def _linear_terms(
    layout: SampleLayout, grid: SampleGrid, robot: RobotModel, config: KinematicSqpConfig
) -> list[LinearTerm]:
    weights = config.weights
    height = float(robot.nominal_state().position_base_in_world[2])
    base = ("base_position", "base_rotation")
    return [
        travel_distance("travel_distance_transition", layout, grid, False, weights.travel_distance_transition),
        travel_distance("travel_distance_periodic", layout, grid, True, weights.travel_distance_periodic),
        turning_angle("turning_angle_transition", layout, grid, False, weights.turning_angle_transition),
        turning_angle("turning_angle_periodic", layout, grid, True, weights.turning_angle_periodic),
        smoothness("smooth_base", base, layout, grid, weights.smooth_base),
        smoothness("smooth_joints", ("joints",), layout, grid, weights.smooth_joints),
        smoothness("smooth_com", ("com",), layout, grid, weights.smooth_com),
        smoothness("smooth_feet", ("feet",), layout, grid, weights.smooth_feet),
        nominal_stance(layout, height, robot.nominal_joint_positions, weights.regulariser),
        even_loads(layout, grid.support, weights.even_loads),
    ]


def _equalities(layout: SampleLayout, grid: SampleGrid, start: StartSample) -> list[Equality]:
    return [
        start_pose(layout, start),
        start_velocity(layout, start, float(grid.periods_s[0])),
        grounded_feet(layout, grid),
        periodic_joints(layout, grid),
        rest_at_end(layout, grid),
        unloaded_feet(layout, grid.support),
        load_sum(layout, grid.support),
    ]


def _inequalities(
    layout: SampleLayout, grid: SampleGrid, robot: RobotModel, config: KinematicSqpConfig
) -> list[Inequality]:
    return [
        load_range(layout, grid.support, config.least_load),
        joint_speed(layout, grid, config.joint_speed_radps),
        joint_limits(layout, robot.joint_position_limits),
    ]
