"""One weighted objective under hard limits: the hierarchy's answer without conflict, a compromise with one."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from preset_cases import near_rest, preset, resolved
from pydantic import ValidationError

from quadlab.controllers.hierarchy import StackedLevels
from quadlab.controllers.task_stack import TaskStack
from quadlab.controllers.weighted import WeightedResolver
from quadlab.geometry.rotations import Array
from quadlab.robots.model import RobotModel

STANCES = ([0, 1, 2, 3], [0, 1, 3], [1, 2])


def weighted(**weights: float) -> Any:
    overrides = [f"weights.{name}={weight:e}" for name, weight in weights.items()]
    return preset("weighted", *overrides)


def torso_acceleration(robot: RobotModel, forces_weight: float, stance: list[int]) -> tuple[Array, float]:
    """Base acceleration, and norm of the contact forces, for a weight on the forces."""
    kinematics, reference = near_rest(robot, stance)
    resolution = resolved(weighted(forces=forces_weight), kinematics, reference)
    return resolution.accelerations[:6], float(np.linalg.norm(resolution.contact_forces))


@pytest.mark.parametrize("seed", range(4))
def test_equals_the_hierarchy_where_nothing_conflicts(robot: RobotModel, seed: int) -> None:
    """The torso can be met; the forces' weight is too small to matter but decides what the torso leaves open."""
    kinematics, reference = near_rest(robot, [0, 1, 2, 3], seed)
    strict = resolved(preset("hierarchical"), kinematics, reference)
    assert strict.residuals["torso"] < 1e-6
    soft = resolved(weighted(forces=1e-9), kinematics, reference)
    np.testing.assert_allclose(soft.torques, strict.torques, atol=1e-3 * np.abs(strict.torques).max())
    np.testing.assert_allclose(soft.accelerations, strict.accelerations, atol=1e-2)


def test_more_weight_means_smaller_forces_and_a_torso_that_sinks(robot: RobotModel) -> None:
    weights = (1e-8, 1e-5, 1e-3, 1e-1)
    outcomes = [torso_acceleration(robot, weight, [0, 1, 2, 3]) for weight in weights]
    for (base, force), (next_base, next_force) in pairwise(outcomes):
        assert next_force < force
        assert next_base[2] < base[2] + 1e-9
    assert outcomes[-1][0][2] < -5.0, "with dominating weight on the forces the robot falls"


def test_compromise_is_stationary(robot: RobotModel) -> None:
    """Torques a little off the optimum, along directions that no limit forbids, cost more."""
    kinematics, reference = near_rest(robot, [0, 1, 2, 3])
    resolver = WeightedResolver(weighted(forces=1e-2))
    _, levels = resolver.assemble(kinematics, reference)
    torques = resolver.resolve(kinematics, reference, np.zeros(12)).torques
    objective = slice(levels.breaks[-2], levels.breaks[-1])
    matrix, target = levels.matrix[objective], levels.upper[objective]
    np.testing.assert_allclose(matrix.T @ (matrix @ torques - target), 0.0, atol=1e-6 * np.abs(matrix).max())


@pytest.mark.parametrize("stance", STANCES, ids=str)
def test_objective_is_the_sum_of_weighted_squares(robot: RobotModel, stance: list[int]) -> None:
    """What the docstring prints: sum_k weight_k |A_k x - b_k|^2, at any torques."""
    config = weighted(swing=3.0, torso=0.5, forces=1e-2)
    kinematics, reference = near_rest(robot, stance)
    space, levels = WeightedResolver(config).assemble(kinematics, reference)
    torques = np.random.default_rng(0).uniform(-1.0, 1.0, 12) * robot.torque_limits
    stack = TaskStack(config.levels)
    squares = dict(zip(stack.names, squared(stack.assemble(kinematics, reference, space), torques), strict=True))
    expected = sum(weight * squares[name] for name, weight in config.weights.items())
    assert squared(levels, torques)[-1] == pytest.approx(expected)


def squared(levels: StackedLevels, torques: Array) -> list[float]:
    """|A x - b|^2 of each level, with b its upper bound."""
    residuals = levels.matrix @ torques - levels.upper
    return [float(np.sum(residuals[begin:end] ** 2)) for begin, end in pairwise(levels.breaks)]


@pytest.mark.parametrize("stance", STANCES, ids=str)
def test_limits_stay_hard_under_any_weight(robot: RobotModel, stance: list[int]) -> None:
    kinematics, reference = near_rest(robot, stance, size=1.0)
    resolution = resolved(weighted(torso=1e6, swing=1e6, forces=1e3), kinematics, reference)
    assert resolution.residuals["torque"] < 1e-6
    assert resolution.residuals["friction"] < 1e-6
    assert np.all(np.abs(resolution.torques) <= robot.torque_limits * (1 + 1e-9))


@pytest.mark.parametrize(
    "weights",
    [{"torque": 1.0}, {"forces": 1.0, "dance": 1.0}, {"swing": 1.0, "forces": 1.0}, {"forces": 0.0}, {}],
    ids=str,
)
def test_weights_must_be_positive_and_name_the_last_levels(weights: dict[str, float]) -> None:
    values = {**preset("weighted").model_dump(), "weights": weights}
    with pytest.raises(ValidationError):
        WeightedResolver.Config.model_validate(values)
