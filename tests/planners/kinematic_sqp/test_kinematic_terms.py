"""Every derivative agrees with finite differences, every equality holds for any free variables."""

import numpy as np
import pytest
from kinematic_cases import PAPER_MOTIONS, ROBOTS, WHOLE_MOTIONS, planner, problem, robot

from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.elimination import eliminate
from quadlab.planners.kinematic_sqp.kinematics import SampleKinematics
from quadlab.planners.kinematic_sqp.program import KinematicProgram
from quadlab.planners.kinematic_sqp.term import Jacobians, fix, tie

STEP = 1e-6
TERMS = ("com_consistency", "feet_consistency", "dynamic_stability")
MOTIONS = {"open": PAPER_MOTIONS["turning_trot"], "whole": WHOLE_MOTIONS["transition"]}


def program(robot_name: str, motion: str) -> KinematicProgram:
    return planner().build(problem(robot_name, MOTIONS[motion])).program


def somewhere(program: KinematicProgram, seed: int = 0) -> Array:
    noise: Array = 0.002 * np.random.default_rng(seed).standard_normal(program.layout.size)
    return program.guess + noise


@pytest.mark.parametrize("robot_name", ROBOTS)
def test_kinematics_are_those_of_the_robot(robot_name: str) -> None:
    model = robot(robot_name)
    state = model.nominal_state()
    pose = np.concatenate([state.position_base_in_world, np.zeros(3), state.joint_positions])
    com, feet = SampleKinematics(model).positions(pose[None])
    expected = model.kinematics(state)
    np.testing.assert_allclose(com[0], expected.com_position, atol=1e-12)
    np.testing.assert_allclose(feet[0], expected.foot_positions, atol=1e-12)


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("number", range(len(TERMS)), ids=TERMS)
def test_block_jacobian_agrees_with_finite_differences(motion: str, number: int) -> None:
    built = program("anymal_b", motion)
    term, p = built.block_terms[number], somewhere(built)
    assert term.name == TERMS[number]
    jacobian = term.jacobian(p, Jacobians(*built.kinematics.jacobians(built.layout.poses(p))))
    direction = np.random.default_rng(1).standard_normal(built.layout.size)
    ahead, behind = (
        term.residual(moved, built.coordinates(moved)) for moved in (p + STEP * direction, p - STEP * direction)
    )
    predicted = np.einsum("smv,sv->sm", jacobian, direction[term.variables])
    np.testing.assert_allclose(predicted, (ahead - behind) / (2.0 * STEP), rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("motion", MOTIONS)
def test_gradient_of_the_whole_objective_agrees_with_finite_differences(motion: str) -> None:
    built = program("hyq", motion)
    y = built.elimination.restrict(somewhere(built))
    direction = np.random.default_rng(2).standard_normal(len(y))
    ahead, behind = (
        sum(built.costs(built.elimination.expand(y + step * direction)).values()) for step in (STEP, -STEP)
    )
    assert built.linearise(y).gradient @ direction == pytest.approx((ahead - behind) / (2.0 * STEP), rel=1e-5)


def test_hessian_is_that_of_the_residuals() -> None:
    """H = 2 J^T W J + damping, with J from finite differences of the residuals along a direction."""
    built = program("anymal_b", "open")
    y = built.elimination.restrict(somewhere(built))
    direction = np.random.default_rng(3).standard_normal(len(y))
    curvature = 1e-4 * direction @ direction
    ends = [built.elimination.expand(y + step * direction) for step in (STEP, -STEP)]
    for block in built.block_terms:
        ahead, behind = (block.residual(p, built.coordinates(p)) for p in ends)
        curvature += 2.0 * block.weight * float((((ahead - behind) / (2.0 * STEP)) ** 2).sum())
    for linear in built.linear_terms:
        change = (linear.residual(ends[0]) - linear.residual(ends[1])) / (2.0 * STEP)
        curvature += 2.0 * linear.weight * float((change**2).sum())
    hessian = built.linearise(y).hessian
    assert direction @ (hessian @ direction) == pytest.approx(curvature, rel=1e-5)
    assert abs(hessian - hessian.T).max() < 1e-6


@pytest.mark.parametrize("motion", MOTIONS)
def test_equalities_hold_for_any_free_variables(motion: str) -> None:
    built = program("anymal_b", motion)
    y = np.random.default_rng(4).standard_normal(len(built.elimination.free))
    p = built.elimination.expand(y)
    for equality in built.equalities:
        assert equality.violation(p) < 1e-12, equality.name
    np.testing.assert_array_equal(built.elimination.restrict(p), y)


def test_substitutions_follow_each_other() -> None:
    """A = 2, b = a, c = b + 1, d free."""
    index = np.arange(4)
    elimination = eliminate(
        [fix("a", index[:1], 2.0), tie("b", index[1:2], index[:1]), tie("c", index[2:3], index[1:2], 1.0)], 4
    )
    np.testing.assert_allclose(elimination.expand(np.array([7.0])), [2.0, 2.0, 3.0, 7.0])
