"""The papers' decision vectors have the same solutions as the reduced form in torques."""

from collections.abc import Callable

import numpy as np
import pytest
from controller_cases import STANCES, any_state
from preset_cases import near_rest, preset

from quadlab.controllers.decision_space import DecisionSpace
from quadlab.controllers.full_space import accelerations_forces, accelerations_torques
from quadlab.controllers.hierarchy import HierarchySolution, HierarchyStatus, certificate, solve_hierarchy, unstack
from quadlab.controllers.reduced_dynamics import reduce_dynamics
from quadlab.controllers.task_stack import TaskStack
from quadlab.geometry.rotations import Array
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.model import RobotModel

Space = Callable[[Kinematics, list[int]], DecisionSpace]
full_spaces = pytest.mark.parametrize("full_space", [accelerations_forces, accelerations_torques])
ON_FEET = STANCES[:-1]


def solution_in(
    space: Space, name: str, robot: RobotModel, stance: list[int], seed: int
) -> tuple[DecisionSpace, HierarchySolution, Array]:
    """The hierarchy of a preset solved in a space, and the certificates of its levels."""
    kinematics, reference = near_rest(robot, stance, seed)
    stack = TaskStack(preset(name).levels)
    decision = space(kinematics, reference.stance_legs)
    stacked = stack.assemble(kinematics, reference, decision)
    levels = unstack(stacked, [*(level.name for level in decision.constraints), *stack.names])
    solution = solve_hierarchy(levels, decision.nearest(np.zeros(12)))
    return decision, solution, certificate(levels, solution.x)


@full_spaces
@pytest.mark.parametrize("stance", ON_FEET, ids=str)
@pytest.mark.parametrize("seed", range(2))
def test_maps_and_constraints_are_the_equations_of_motion(
    robot: RobotModel, full_space: Space, stance: list[int], seed: int
) -> None:
    """Torques, forces and accelerations of the reduced form satisfy the constraints, and the maps give them back."""
    kinematics = robot.kinematics(any_state(robot, seed))
    torques = np.random.default_rng(seed).uniform(-1.0, 1.0, 12) * robot.torque_limits
    reduced, full = reduce_dynamics(kinematics, stance), full_space(kinematics, stance)
    accelerations, forces = reduced.accelerations(torques), reduced.forces(torques)
    x = np.concatenate([accelerations, torques if full_space is accelerations_torques else forces.ravel()])
    scale = max(np.abs(accelerations).max(), np.abs(forces).max())
    np.testing.assert_allclose(full.accelerations(x), accelerations, atol=1e-9 * scale)
    np.testing.assert_allclose(full.torques(x), torques, atol=1e-9 * scale)
    np.testing.assert_allclose(full.forces(x), forces, atol=1e-9 * scale)
    for level in full.constraints:
        np.testing.assert_allclose(level.matrix @ x, level.upper, atol=1e-9 * scale)
        np.testing.assert_array_equal(level.lower, level.upper)


@full_spaces
@pytest.mark.parametrize("stance", STANCES, ids=str)
def test_constraints_leave_as_much_freedom_as_there_are_torques(
    robot: RobotModel, full_space: Space, stance: list[int]
) -> None:
    full = full_space(robot.kinematics(any_state(robot, 3)), stance)
    rank = np.linalg.matrix_rank(np.concatenate([level.matrix for level in full.constraints]), tol=1e-8)
    assert full.size - rank == 12


@full_spaces
@pytest.mark.parametrize("name", ["hierarchical", "bellicoso2016", "gehring2017"])
@pytest.mark.parametrize("stance", ON_FEET, ids=str)
@pytest.mark.parametrize("seed", range(2))
def test_every_level_is_met_as_well_as_in_the_reduced_form(
    robot: RobotModel, full_space: Space, name: str, stance: list[int], seed: int
) -> None:
    reduced_space, reduced, _ = solution_in(reduce_dynamics, name, robot, stance, seed)
    space, solution, remainders = solution_in(full_space, name, robot, stance, seed)
    assert solution.status is HierarchyStatus.SOLVED
    assert remainders.max() < 1e-6
    assert solution.residual_norms["dynamics"] < 1e-6
    assert solution.residual_norms["contacts"] < 1e-6
    for level, norm in reduced.residual_norms.items():
        assert solution.residual_norms[level] == pytest.approx(norm, rel=1e-5, abs=1e-5)
    # The last level, forces, decides whatever is left, so that the solution is unique.
    forces = reduced_space.forces(reduced.x)
    scale = max(1.0, float(np.abs(forces).max()))
    np.testing.assert_allclose(space.forces(solution.x), forces, atol=1e-5 * scale)
    np.testing.assert_allclose(space.torques(solution.x), reduced_space.torques(reduced.x), atol=1e-5 * scale)
    np.testing.assert_allclose(
        space.accelerations(solution.x), reduced_space.accelerations(reduced.x), atol=1e-4 * scale
    )


def test_nearest_decision_has_the_torques_that_were_asked_for(robot: RobotModel) -> None:
    kinematics = robot.kinematics(robot.nominal_state())
    torques = np.linspace(-1.0, 1.0, 12)
    for space in (reduce_dynamics, accelerations_forces, accelerations_torques):
        decision = space(kinematics, [0, 1, 2, 3])
        np.testing.assert_allclose(decision.torques(decision.nearest(torques)), torques, atol=1e-9)
