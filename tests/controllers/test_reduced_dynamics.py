"""Accelerations and contact forces that follow from torques: exact, for every number of standing legs."""

import numpy as np
import pytest
from controller_cases import STANCES, any_state

from quadlab.controllers.reduced_dynamics import reduce_dynamics
from quadlab.controllers.task_stack import in_decision_variables
from quadlab.controllers.tasks.task import TaskRows, Variable
from quadlab.robots.model import RobotModel


@pytest.mark.parametrize("stance", STANCES, ids=str)
@pytest.mark.parametrize("seed", range(3))
def test_equations_of_motion_and_contacts_hold(robot: RobotModel, stance: list[int], seed: int) -> None:
    kinematics = robot.kinematics(any_state(robot, seed))
    torques = np.random.default_rng(seed).uniform(-1.0, 1.0, 12) * robot.torque_limits
    dynamics = reduce_dynamics(kinematics, stance)
    accelerations, forces = dynamics.accelerations(torques), dynamics.forces(torques)
    jacobians = kinematics.contact_jacobians[stance]
    generalized_forces = np.einsum("lij,li->j", jacobians, forces) - kinematics.nonlinear_effects
    generalized_forces[6:] += torques
    scale = np.abs(generalized_forces).max()
    np.testing.assert_allclose(kinematics.mass_matrix @ accelerations, generalized_forces, atol=1e-10 * scale)
    contact_accelerations = jacobians @ accelerations + kinematics.contact_bias[stance]
    np.testing.assert_allclose(contact_accelerations, 0.0, atol=1e-9 * np.abs(accelerations).max())


@pytest.mark.parametrize("stance", STANCES, ids=str)
def test_reduction_equals_the_direct_solution(robot: RobotModel, stance: list[int]) -> None:
    kinematics = robot.kinematics(any_state(robot, 7))
    torques = np.random.default_rng(7).uniform(-1.0, 1.0, 12) * robot.torque_limits
    jacobian = kinematics.contact_jacobians[stance].reshape(-1, 18)
    size = len(jacobian)
    saddle = np.block([[kinematics.mass_matrix, -jacobian.T], [jacobian, np.zeros((size, size))]])
    inputs = np.concatenate([np.zeros(6), torques]) - kinematics.nonlinear_effects
    direct = np.linalg.solve(saddle, np.concatenate([inputs, -kinematics.contact_bias[stance].ravel()]))
    dynamics = reduce_dynamics(kinematics, stance)
    np.testing.assert_allclose(dynamics.accelerations(torques), direct[:18], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(dynamics.forces(torques).ravel(), direct[18:], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("variable", list(Variable))
def test_rows_mean_the_same_when_written_in_torques(robot: RobotModel, variable: Variable) -> None:
    """A row is as far from its bounds in its own variable as in torques."""
    generator = np.random.default_rng(11)
    dynamics = reduce_dynamics(robot.kinematics(any_state(robot, 11)), [0, 2, 3])
    torques = generator.uniform(-1.0, 1.0, 12) * robot.torque_limits
    block = {
        Variable.ACCELERATION: dynamics.accelerations(torques),
        Variable.FORCE: dynamics.forces(torques).ravel(),
        Variable.TORQUE: torques,
    }[variable]
    rows = TaskRows(variable, generator.normal(size=(5, len(block))), np.full(5, -np.inf), generator.normal(size=5))
    matrix, lower, upper = in_decision_variables([rows], dynamics)
    np.testing.assert_allclose(upper - matrix @ torques, rows.upper - rows.matrix @ block, rtol=1e-9, atol=1e-8)
    assert np.all(np.isneginf(lower))


@pytest.mark.parametrize("variable", list(Variable))
@pytest.mark.parametrize("change", [(0, 1, 0, 0), (0, -1, 0, 0), (1, 0, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)])
def test_task_whose_rows_do_not_fit_is_refused(
    robot: RobotModel, variable: Variable, change: tuple[int, int, int, int]
) -> None:
    """Compiled code would read and write what lies beside them."""
    stance = [0, 2, 3]
    dynamics = reduce_dynamics(robot.kinematics(any_state(robot, 11)), stance)
    columns = {Variable.ACCELERATION: 18, Variable.TORQUE: 12, Variable.FORCE: 3 * len(stance)}[variable]
    rows, width, lower, upper = np.add((5, columns, 5, 5), change).tolist()
    fitting = TaskRows(variable, np.zeros((5, columns)), np.zeros(5), np.zeros(5))
    misshapen = TaskRows(variable, np.zeros((rows, width)), np.zeros(lower), np.zeros(upper))
    with pytest.raises(ValueError, match=rf"task 1 of the stack, in {variable}: .*; expected \(m, {columns}\), \(m,\)"):
        in_decision_variables([fitting, misshapen], dynamics)


def test_falling_robot_falls(robot: RobotModel) -> None:
    """Without contacts and torques the centre of mass has the acceleration of gravity."""
    kinematics = robot.kinematics(any_state(robot, 5))
    dynamics = reduce_dynamics(kinematics, [])
    assert dynamics.forces(np.zeros(12)).shape == (0, 3)
    fall = kinematics.com_jacobian @ dynamics.accelerations(np.zeros(12)) + kinematics.com_bias
    np.testing.assert_allclose(fall, [0.0, 0.0, -9.81], atol=1e-9)
