"""The simulated robot carries what the controller does not know of, and nothing else changes."""

from typing import Any

import mujoco
import numpy as np
import pytest
from simulation_cases import NO_ERROR

from quadlab.geometry.rotations import Array
from quadlab.robots.catalogue import robot_config
from quadlab.robots.model import RobotModel, load_robot
from quadlab.simulation.model_builder import build_spec
from quadlab.simulation.model_error import ModelErrorConfig, apply_model_error
from quadlab.simulation.terrain import build_ground

POSITION = (0.2, -0.1, 0.3)  # [m]


@pytest.fixture(scope="module")
def robot() -> RobotModel:
    return load_robot(robot_config("anymal_b"))


def _data(robot: RobotModel, error: ModelErrorConfig) -> tuple[Any, Any]:
    spec = build_spec(robot, build_ground(()), 0.8, 0.001)
    apply_model_error(spec, robot.config.base_link, error)
    model: Any = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[:] = 0.3
    mujoco.mj_forward(model, data)
    return model, data


def _mass_matrix(model: Any, data: Any) -> Array:
    matrix = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, matrix)
    return matrix


def test_no_error_changes_nothing(robot: RobotModel) -> None:
    model: Any = build_spec(robot, build_ground(()), 0.8, 0.001).compile()
    changed, _ = _data(robot, NO_ERROR)
    np.testing.assert_array_equal(changed.body_inertia, model.body_inertia)
    np.testing.assert_array_equal(changed.body_mass, model.body_mass)


def test_payload_adds_the_kinetic_energy_of_a_point_mass(robot: RobotModel) -> None:
    mass = 4.0
    model, data = _data(robot, NO_ERROR)
    loaded, loaded_data = _data(robot, NO_ERROR.model_copy(update={"payload_kg": mass, "payload_position_m": POSITION}))
    added = _mass_matrix(loaded, loaded_data) - _mass_matrix(model, data)
    jacobian, base = np.zeros((3, model.nv)), model.body(robot.config.base_link).id
    point = data.xpos[base] + data.xmat[base].reshape(3, 3) @ POSITION
    mujoco.mj_jac(model, data, jacobian, None, point, base)
    np.testing.assert_allclose(added, mass * jacobian.T @ jacobian, atol=1e-9)


def test_inertia_scale_leaves_masses_alone(robot: RobotModel) -> None:
    model, _ = _data(robot, NO_ERROR)
    scaled, _ = _data(robot, NO_ERROR.model_copy(update={"inertia_scale": 1.3}))
    np.testing.assert_allclose(scaled.body_inertia, 1.3 * model.body_inertia)
    np.testing.assert_array_equal(scaled.body_mass, model.body_mass)


def test_weak_drives_give_less_than_they_are_asked_for(robot: RobotModel) -> None:
    model, data = _data(robot, NO_ERROR.model_copy(update={"torque_scale": 0.9}))
    data.ctrl[:] = 10.0
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.actuator_force, 9.0)
