"""MuJoCo and Pinocchio, built from one description, agree on kinematics and dynamics of every robot."""

from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from quadlab.geometry.rotations import Array, quat_to_matrix, skew
from quadlab.robots.catalogue import robot_config, robot_names
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.state import RobotState
from quadlab.simulation.conventions import MujocoMap, foot_geom
from quadlab.simulation.ground import Ground
from quadlab.simulation.links import link_placements
from quadlab.simulation.model_builder import build_spec

STATES = 20


class Pair:
    """A robot and its compiled MuJoCo model far above the ground."""

    def __init__(self, name: str) -> None:
        self.robot: RobotModel = load_robot(robot_config(name))
        self.model: Any = build_spec(self.robot, Ground(-100.0, ()), 0.8, 0.001).compile()
        self.data: Any = mujoco.MjData(self.model)
        self.map = MujocoMap.of(self.model, self.robot)
        self.generator = np.random.default_rng(11)

    def random_state(self) -> RobotState:
        """Draw a state, write it to MuJoCo's data and evaluate it there."""
        draw = self.generator
        lower, upper = self.robot.joint_position_limits.T
        quat = draw.normal(size=4)
        state = replace(
            self.robot.nominal_state(),
            position_base_in_world=draw.normal(size=3),
            quat_wxyz=quat / np.linalg.norm(quat),
            joint_positions=draw.uniform(lower + 0.01, upper - 0.01),
            linear_velocity_base_in_world=draw.normal(size=3),
            angular_velocity_base_in_base=draw.normal(size=3),
            joint_velocities=3.0 * draw.normal(size=12),
        )
        self.map.write_state(self.data, state)
        mujoco.mj_forward(self.model, self.data)
        return state


@pytest.fixture(params=robot_names())
def pair(request: pytest.FixtureRequest) -> Pair:
    return Pair(request.param)


def relative_error(first: Array, second: Array) -> float:
    return float(np.abs(first - second).max() / np.abs(second).max())


def mujoco_mass_matrix(pair: Pair) -> Array:
    matrix = np.zeros((18, 18))
    mujoco.mj_fullM(pair.model, pair.data, matrix)
    return matrix


def test_states_survive_the_border(pair: Pair) -> None:
    state = pair.random_state()
    read = pair.map.read_state(pair.data, 0.0)
    for name in ("position_base_in_world", "quat_wxyz", "joint_positions", "joint_velocities"):
        np.testing.assert_allclose(getattr(read, name), getattr(state, name), atol=1e-14, err_msg=name)
    np.testing.assert_allclose(read.linear_velocity_base_in_world, state.linear_velocity_base_in_world, atol=1e-14)
    np.testing.assert_allclose(read.angular_velocity_base_in_base, state.angular_velocity_base_in_base, atol=1e-14)


def test_generalised_velocities_agree(pair: Pair) -> None:
    state = pair.random_state()
    transform = pair.map.velocity_transform(state.quat_wxyz)
    velocity = transform @ pair.robot.kinematics(state).generalized_velocity
    np.testing.assert_allclose(velocity, pair.data.qvel, atol=1e-13)


def test_mass_matrices_agree(pair: Pair) -> None:
    for _ in range(STATES):
        state = pair.random_state()
        transform = pair.map.velocity_transform(state.quat_wxyz)
        ours = pair.robot.kinematics(state).mass_matrix
        assert relative_error(transform.T @ mujoco_mass_matrix(pair) @ transform, ours) < 1e-10


def test_unforced_accelerations_agree(pair: Pair) -> None:
    """M u_dot + h = 0; MuJoCo's acceleration is that of the same motion in its own coordinates."""
    for _ in range(STATES):
        state = pair.random_state()
        ours = pair.robot.kinematics(state)
        transform = pair.map.velocity_transform(state.quat_wxyz)
        u = ours.generalized_velocity
        acceleration = transform @ np.linalg.solve(ours.mass_matrix, -ours.nonlinear_effects)
        acceleration[:3] += ours.base_rotation @ (skew(u[3:6]) @ u[:3])
        assert relative_error(acceleration, pair.data.qacc_smooth) < 1e-8


def test_nonlinear_effects_agree(pair: Pair) -> None:
    """The force that holds the acceleration at zero, in both coordinates."""
    for _ in range(STATES):
        state = pair.random_state()
        ours = pair.robot.kinematics(state)
        transform = pair.map.velocity_transform(state.quat_wxyz)
        u = ours.generalized_velocity
        drift = np.concatenate([ours.base_rotation @ (skew(u[3:6]) @ u[:3]), np.zeros(15)])
        bias = pair.data.qfrc_bias - pair.data.qfrc_passive
        theirs = transform.T @ (mujoco_mass_matrix(pair) @ drift + bias)
        assert relative_error(theirs, ours.nonlinear_effects) < 1e-9


def test_torques_accelerate_the_same_joints(pair: Pair) -> None:
    state = pair.random_state()
    ours = pair.robot.kinematics(state)
    transform = pair.map.velocity_transform(state.quat_wxyz)
    before = pair.data.qacc_smooth.copy()
    torques = pair.robot.torque_limits * np.linspace(-0.9, 0.9, 12)
    pair.data.ctrl[pair.map.ctrl] = torques
    mujoco.mj_forward(pair.model, pair.data)
    forces = np.concatenate([np.zeros(6), torques])
    expected = transform @ np.linalg.solve(ours.mass_matrix, forces)
    assert relative_error(pair.data.qacc_smooth - before, expected) < 1e-8


def test_foot_centres_and_their_jacobians_agree(pair: Pair) -> None:
    for _ in range(STATES):
        state = pair.random_state()
        ours = pair.robot.kinematics(state)
        transform = pair.map.velocity_transform(state.quat_wxyz)
        for leg in range(4):
            geom = pair.model.geom(foot_geom(leg))
            center = pair.data.geom_xpos[geom.id]
            np.testing.assert_allclose(center, ours.foot_centers[leg], atol=1e-12)
            jacobian = np.zeros((3, 18))
            mujoco.mj_jac(pair.model, pair.data, jacobian, None, center, geom.bodyid[0])
            np.testing.assert_allclose(jacobian @ transform, ours.foot_jacobians[leg], atol=1e-12)
            mujoco.mj_jac(pair.model, pair.data, jacobian, None, ours.foot_positions[leg], geom.bodyid[0])
            np.testing.assert_allclose(jacobian @ transform, ours.contact_jacobians[leg], atol=1e-12)


def test_every_link_is_where_its_placement_says(pair: Pair) -> None:
    state = pair.random_state()
    q, _ = pair.robot.to_pinocchio(state)
    model = pair.robot.pin_model
    workspace = model.createData()
    pin.framesForwardKinematics(model, workspace, q)
    placements = link_placements(pair.robot)
    assert len(placements) >= 17
    for link, placement in placements.items():
        body = pair.data.body(placement.body)
        pose = workspace.oMf[model.getFrameId(link, pin.FrameType.BODY)]
        position = body.xpos + quat_to_matrix(body.xquat) @ placement.position
        rotation = quat_to_matrix(body.xquat) @ quat_to_matrix(placement.quat_wxyz)
        np.testing.assert_allclose(position, pose.translation, atol=1e-10, err_msg=link)
        np.testing.assert_allclose(rotation, pose.rotation, atol=1e-10, err_msg=link)


def test_total_mass_agrees(pair: Pair) -> None:
    assert pair.model.body_mass.sum() == pytest.approx(pair.robot.mass, rel=1e-12)
