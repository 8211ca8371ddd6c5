"""What a trial may rely on: torques are clipped, forces balance, equal seeds give equal trials."""

import re
from collections.abc import Sequence

import numpy as np
import pytest
from simulation_cases import exact_simulation

from quadlab.errors import ConfigurationError, QuadlabError
from quadlab.geometry.rotations import Array
from quadlab.robots.catalogue import robot_config, robot_names
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.state import JointCommand, RobotState
from quadlab.simulation.push import PushConfig
from quadlab.simulation.scenario import InitialPerturbationConfig, ScenarioConfig
from quadlab.simulation.simulator import Simulator
from quadlab.simulation.terrain import PlankConfig, TerrainConfig
from quadlab.simulation.timing import check_period

TIMESTEP = 0.00125  # [s]
GRAVITY = 9.81  # [m/s^2]
NO_TORQUE = JointCommand(np.zeros(12))
UNPERTURBED = InitialPerturbationConfig(yaw_deg=0.0, pitch_deg=0.0, roll_deg=0.0, joint_rad=0.0, velocity_mps=0.0)
PERTURBED = InitialPerturbationConfig(yaw_deg=10.0, pitch_deg=3.0, roll_deg=3.0, joint_rad=0.05, velocity_mps=0.2)


def simulator(
    robot: RobotModel,
    terrain: Sequence[TerrainConfig] = (),
    pushes: Sequence[PushConfig] = (),
    perturbation: InitialPerturbationConfig = UNPERTURBED,
    seed: int = 0,
) -> Simulator:
    scenario = ScenarioConfig(
        name="test",
        friction=0.8,
        terrain=tuple(terrain),
        pushes=tuple(pushes),
        initial_perturbation=perturbation,
    )
    return Simulator(robot, scenario, exact_simulation(TIMESTEP), seed)


def push(force: float, direction: tuple[float, float, float], duration: float, body: str = "base") -> PushConfig:
    return PushConfig(body=body, direction=direction, force_n=force, start_s=0.1, duration_s=duration)


class Stand:
    """Gravity compensation and a joint PD soft enough for the bare knee inertia at this timestep."""

    def __init__(self, robot: RobotModel) -> None:
        kinematics = robot.kinematics(robot.nominal_state())
        self.robot = robot
        self.derivative_gains = 0.3 * np.diag(kinematics.mass_matrix)[6:] / TIMESTEP
        self.proportional_gains = 20.0 * self.derivative_gains
        support = np.concatenate([jacobian[:, :6].T for jacobian in kinematics.contact_jacobians], axis=1)
        forces = np.linalg.lstsq(support, kinematics.nonlinear_effects[:6], rcond=None)[0].reshape(4, 3)
        carried = np.einsum("lij,li->j", kinematics.contact_jacobians[:, :, 6:], forces)
        self.feed_forward = kinematics.nonlinear_effects[6:] - carried

    def __call__(self, state: RobotState) -> JointCommand:
        """Return the torques that hold the nominal stance."""
        error = self.robot.nominal_joint_positions - state.joint_positions
        feedback = self.proportional_gains * error - self.derivative_gains * state.joint_velocities
        return JointCommand(self.feed_forward + feedback)


def run_standing(trial: Simulator, stand: Stand, duration: float) -> RobotState:
    for _ in range(round(duration / TIMESTEP)):
        trial.advance(stand(trial.read()), TIMESTEP)
    return trial.read()


@pytest.fixture(params=robot_names())
def robot(request: pytest.FixtureRequest) -> RobotModel:
    return load_robot(robot_config(request.param))


@pytest.fixture(scope="module")
def anymal() -> RobotModel:
    return load_robot(robot_config("anymal_b"))


def test_standing_feet_carry_the_weight_upwards(robot: RobotModel) -> None:
    state = run_standing(simulator(robot), Stand(robot), 0.75)
    forces = state.foot_forces_in_world
    assert np.all(forces[:, 2] > 0.0)
    np.testing.assert_allclose(forces.sum(axis=0), [0.0, 0.0, robot.mass * GRAVITY], atol=0.01 * robot.mass)


@pytest.mark.parametrize("name", ["anymal_b", "hyq"])
def test_a_standing_robot_stays_where_it_is(name: str) -> None:
    robot = load_robot(robot_config(name))
    trial = simulator(robot)
    start = trial.read().position_base_in_world
    end = run_standing(trial, Stand(robot), 5.0)
    assert np.abs(end.position_base_in_world - start).max() < 1e-3  # [m]
    assert np.abs(end.joint_velocities).max() < 1e-4  # [rad/s]


def test_first_reading_is_the_nominal_stance(robot: RobotModel) -> None:
    state, nominal = simulator(robot).reset(), robot.nominal_state()
    np.testing.assert_allclose(state.position_base_in_world, nominal.position_base_in_world, atol=1e-12)
    np.testing.assert_allclose(state.joint_positions, nominal.joint_positions, atol=1e-12)
    assert state.time_s == 0.0


def test_a_robot_without_torque_falls_onto_the_ground_and_not_through_it(robot: RobotModel) -> None:
    trial = simulator(robot)
    start = trial.read().position_base_in_world[2]
    trial.advance(NO_TORQUE, 2.0)
    state = trial.read()
    assert state.is_finite()
    assert 0.0 < state.position_base_in_world[2] < 0.8 * start


def test_torques_are_clipped_to_the_limits(robot: RobotModel) -> None:
    trial = simulator(robot)
    signs = np.tile([1.0, -1.0], 6)
    trial.advance(JointCommand(1e4 * signs), TIMESTEP)
    np.testing.assert_array_equal(trial.applied_torques, signs * robot.torque_limits)
    trial.reset()
    within = 0.5 * signs * robot.torque_limits
    trial.advance(JointCommand(within), TIMESTEP)
    np.testing.assert_array_equal(trial.applied_torques, within)


def test_clipping_also_holds_inside_the_physics(anymal: RobotModel) -> None:
    states = []
    for torques in (anymal.torque_limits, 100.0 * anymal.torque_limits):
        trial = simulator(anymal)
        trial.advance(JointCommand(torques), 0.01)
        states.append(trial.integration_state())
    np.testing.assert_array_equal(states[0], states[1])


def test_torques_that_are_not_finite_are_refused_by_joint(anymal: RobotModel) -> None:
    torques = np.zeros(12)
    torques[4] = np.nan
    with pytest.raises(QuadlabError, match="torque command is not finite: RF_HFE"):
        simulator(anymal).advance(JointCommand(torques), TIMESTEP)


@pytest.mark.parametrize("period", [0.002, 0.0005, 0.003])
def test_a_period_that_is_no_multiple_of_the_timestep_is_refused(anymal: RobotModel, period: float) -> None:
    expected = re.escape(f"a period of {period:g} s is not a whole multiple of the simulation's timestep of 0.00125 s")
    with pytest.raises(ConfigurationError, match=expected):
        simulator(anymal).advance(NO_TORQUE, period)


@pytest.mark.parametrize(
    ("period", "timestep", "steps"), [(0.0025, 0.00125, 2), (0.1, 0.001, 100), (0.3, 0.1, 3), (60.0, 0.00125, 48000)]
)
def test_decimal_periods_count_as_multiples(period: float, timestep: float, steps: int) -> None:
    assert check_period(period, timestep) == steps


def test_time_does_not_drift(anymal: RobotModel) -> None:
    trial = simulator(anymal)
    for _ in range(400):
        trial.advance(NO_TORQUE, 0.0025)
    assert trial.time_s == pytest.approx(1.0, abs=1e-12)
    assert trial.read().time_s == trial.time_s


def falling_trial(trial: Simulator, reads_per_tick: int = 1) -> Array:
    """One second of a noisy controller; returns the final state bit by bit."""
    generator = np.random.default_rng(5)
    for _ in range(400):
        for _ in range(reads_per_tick):
            trial.read()
            trial.body_poses()
            trial.active_pushes()
        trial.advance(JointCommand(generator.normal(scale=5.0, size=12)), 0.0025)
    return trial.integration_state()


def test_equal_seeds_give_identical_trials(anymal: RobotModel) -> None:
    shove = push(100.0, (0.0, 1.0, 0.0), 0.2)
    first = simulator(anymal, pushes=[shove], perturbation=PERTURBED, seed=4)
    second = simulator(load_robot(robot_config("anymal_b")), pushes=[shove], perturbation=PERTURBED, seed=4)
    final = falling_trial(first)
    np.testing.assert_array_equal(final, falling_trial(second))
    first.reset()
    np.testing.assert_array_equal(final, falling_trial(first))


def test_looking_does_not_change_the_trial(anymal: RobotModel) -> None:
    shove = push(100.0, (0.0, 1.0, 0.0), 0.2)
    unseen, seen = (falling_trial(simulator(anymal, pushes=[shove]), reads) for reads in (0, 3))
    np.testing.assert_array_equal(unseen, seen)


def test_a_restored_trial_continues_identically(anymal: RobotModel) -> None:
    trial = simulator(anymal, pushes=[push(80.0, (1.0, 0.0, 0.0), 0.5)])
    trial.advance(NO_TORQUE, 0.3)
    saved, seen = trial.integration_state(), trial.read()
    trial.advance(NO_TORQUE, 0.4)
    expected = trial.integration_state()
    restored = trial.restore(saved)
    assert restored.time_s == seen.time_s
    np.testing.assert_array_equal(restored.foot_forces_in_world, seen.foot_forces_in_world)
    trial.advance(NO_TORQUE, 0.4)
    np.testing.assert_array_equal(trial.integration_state(), expected)


@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (0.0, -2.0, 0.0), (0.3, 0.4, 1.0)])
def test_a_push_changes_the_momentum_by_force_times_duration(
    anymal: RobotModel, direction: tuple[float, float, float]
) -> None:
    shove = push(200.0, direction, 0.05)
    trial = simulator(anymal, pushes=[shove])
    trial.model.opt.gravity[:] = 0.0
    trial.model.geom("floor").contype = trial.model.geom("floor").conaffinity = 0
    trial.reset()
    trial.advance(NO_TORQUE, 0.2)
    momentum = anymal.mass * anymal.kinematics(trial.read()).com_velocity
    unit = np.array(direction) / np.linalg.norm(direction)
    np.testing.assert_allclose(momentum, 200.0 * 0.05 * unit, atol=0.02)  # [N s]


def test_pushes_act_exactly_as_long_as_they_last(anymal: RobotModel) -> None:
    trial = simulator(anymal, pushes=[push(10.0, (0.0, 3.0, 0.0), 0.05), push(5.0, (1.0, 0.0, 0.0), 0.1)])
    active = []
    for _ in range(240):
        active.append([force.tolist() for _, force in trial.active_pushes()])
        trial.advance(NO_TORQUE, TIMESTEP)
    assert active[79] == []
    assert active[80] == active[119] == [[0.0, 10.0, 0.0], [5.0, 0.0, 0.0]]
    assert active[120] == active[159] == [[5.0, 0.0, 0.0]]
    assert active[160] == []


def test_a_push_acts_at_the_centre_of_mass_of_its_body(anymal: RobotModel) -> None:
    trial = simulator(anymal, pushes=[push(1.0, (0.0, 1.0, 0.0), 0.1, body="LF_FOOT")])
    trial.advance(NO_TORQUE, 0.1)
    point, _ = trial.active_pushes()[0]
    names, positions, _ = trial.body_poses()
    shank = positions[names.index("LF_SHANK")]
    assert 0.0 < np.linalg.norm(point - shank) < 0.35


def test_pushes_on_unknown_bodies_name_the_known_ones(anymal: RobotModel) -> None:
    with pytest.raises(ConfigurationError, match=r"unknown link 'torso'; known: base, .*LF_SHANK"):
        simulator(anymal, pushes=[push(1.0, (1.0, 0.0, 0.0), 0.1, body="torso")])


def test_a_robot_inside_the_terrain_is_refused(anymal: RobotModel) -> None:
    plank = PlankConfig(
        kind="plank", center_x_m=0.35, center_y_m=0.0, length_m=0.2, width_m=2.0, height_m=0.05, yaw_deg=0.0
    )
    with pytest.raises(ConfigurationError, match=r"the robot starts inside the terrain: .*terrain_0"):
        simulator(anymal, terrain=[plank])
