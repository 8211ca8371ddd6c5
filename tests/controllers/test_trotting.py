"""Controllers trot on their own model: feet that stick where they touch level ground at z = 0."""

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from controller_cases import controller_config, gait_schedule, integrated, moved_state, uniform_plan, with_loads
from preset_cases import preset

from quadlab.controllers.reduced_dynamics import reduce_dynamics
from quadlab.controllers.telemetry import ControlTelemetry, LegMode
from quadlab.controllers.tracking_controller import TrackingController, build_controller
from quadlab.geometry.rotations import Array, tilt_of
from quadlab.robots.kinematics import BASE_LINEAR, Kinematics
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState

DURATION = 2.9  # [s] 0.6 of standing, two strides of 0.8, standing
SPEED = (0.05, 0.0)  # [m/s]


def after_impact(robot: RobotModel, state: RobotState, standing: list[int]) -> RobotState:
    """The state with the feet in ``standing`` brought to rest by the least change of kinetic energy."""
    kinematics = robot.kinematics(state)
    jacobian = kinematics.contact_jacobians[standing].reshape(-1, 18)
    per_impulse = np.linalg.solve(kinematics.mass_matrix, jacobian.T)
    impulse = np.linalg.solve(jacobian @ per_impulse, jacobian @ kinematics.generalized_velocity)
    velocity = kinematics.generalized_velocity - per_impulse @ impulse
    return replace(
        state,
        linear_velocity_base_in_world=state.rotation_base_to_world @ velocity[BASE_LINEAR],
        angular_velocity_base_in_base=velocity[3:6],
        joint_velocities=velocity[6:],
    )


def standing_in(telemetry: ControlTelemetry) -> list[int]:
    return [leg for leg, mode in enumerate(telemetry.leg_modes) if mode is LegMode.STANCE]


def touching(kinematics: Kinematics, standing: list[int]) -> list[int]:
    """Feet that stand, and feet that have come down to the ground."""
    velocities = kinematics.foot_velocities[:, 2]
    landed = (kinematics.foot_positions[:, 2] <= 0.0) & (velocities < 0.0)
    return [leg for leg in range(4) if leg in standing or landed[leg]]


@lru_cache
def trot(
    robot: RobotModel, name: str = "hierarchical"
) -> tuple[TrackingController, tuple[RobotState, ...], tuple[ControlTelemetry, ...]]:
    """Controller after a trot on its own model, and states and telemetry of its ticks."""
    controller = build_controller(preset(name), robot)
    states, ticks = zip(*rollout(robot, controller), strict=True)
    return controller, states, ticks


def rollout(robot: RobotModel, controller: TrackingController) -> Iterator[tuple[RobotState, ControlTelemetry]]:
    state, standing = with_loads(robot, robot.nominal_state()), [0, 1, 2, 3]
    controller.start(uniform_plan(robot, gait_schedule("trot", DURATION), SPEED, com_over_feet=True), state)
    for _ in range(round(DURATION / controller.period_s)):
        loaded = touching(robot.kinematics(state), standing)
        if set(loaded) - set(standing):
            state = after_impact(robot, state, loaded)
        command, telemetry = controller.tick(with_loads(robot, state, loaded))
        yield state, telemetry
        standing = standing_in(telemetry)
        dynamics = reduce_dynamics(robot.kinematics(state), standing)
        state = integrated(robot, state, dynamics.accelerations(command.torques), controller.period_s)


@pytest.mark.parametrize("name", ["hierarchical", "projected_inverse_dynamics"])
def test_trot_follows_its_plan(robot: RobotModel, name: str) -> None:
    controller, states, ticks = trot(robot, name)
    assert controller.fallbacks == 0
    assert [event for tick in ticks for event in tick.events if "skipped" in event or "lost" in event] == []
    errors = np.array([tick.com_position_reference - tick.com_position for tick in ticks])
    assert np.abs(errors[round(0.6 / controller.period_s) :]).max() < 0.03
    assert max(tilt_of(state.rotation_base_to_world) for state in states) < 0.1
    planned = SPEED[0] * DURATION
    assert states[-1].position_base_in_world[0] == pytest.approx(planned, abs=0.04)
    feet = ticks[-1].foot_positions - robot.kinematics(robot.nominal_state()).foot_positions
    assert np.all(feet[:, 0] > 0.4 * planned)


def test_telemetry_of_a_trot_agrees_with_itself(robot: RobotModel) -> None:
    controller, _, ticks = trot(robot)
    schedule, swinging = gait_schedule("trot", DURATION), 0
    for tick in ticks:
        stands = np.array([mode is LegMode.STANCE for mode in tick.leg_modes])
        swinging += int((~stands).sum())
        np.testing.assert_array_equal(tick.planned_contacts, schedule.contacts_at(tick.plan_time_s))
        assert np.all(np.isnan(tick.foot_position_references).any(axis=1) == stands)
        assert np.all(tick.contact_forces_desired[~stands] == 0.0)
        assert np.all(tick.contact_forces_desired[stands, 2] > 0.0)
        assert stands.sum() >= 2
        np.testing.assert_allclose(tick.foot_contact_velocities[stands], 0.0, atol=5e-3)
        assert np.all(np.abs(tick.torques_desired) <= robot.torque_limits * (1 + 1e-9))
        assert tick.level_residuals["friction"] < 1e-6
        assert tuple(tick.level_residuals) == controller.level_names
        assert tick.tick_us == pytest.approx(tick.model_us + tick.reference_us + tick.solve_us)
    assert swinging * controller.period_s == pytest.approx(4 * 2 * 0.35, rel=0.15)


def trotting_torques(robot: RobotModel, shift: Array, yaw: float) -> Array:
    """Torques through one swing of a robot that is held in place, all of it turned and shifted in the world."""
    schedule = gait_schedule("trot", DURATION)
    controller = build_controller(controller_config(), robot)
    plan = uniform_plan(robot, schedule, SPEED, (float(shift[0]), float(shift[1])), yaw)
    nominal = robot.nominal_state()
    controller.start(plan, moved_state(with_loads(robot, nominal), shift, yaw))
    torques = []
    for time in np.arange(0.6, 1.0, controller.period_s):
        loaded = [leg for leg in range(4) if schedule.contacts_at(time)[leg]]
        state = moved_state(with_loads(robot, nominal, loaded), shift, yaw)
        torques.append(controller.tick(replace(state, time_s=time))[0].torques)
    return np.array(torques)


def test_trot_does_not_depend_on_where_the_world_has_its_axes(robot: RobotModel) -> None:
    expected = trotting_torques(robot, np.zeros(2), 0.0)
    assert np.ptp(expected, axis=0).max() > 1.0
    np.testing.assert_allclose(trotting_torques(robot, np.array([3.0, -2.0]), 2.4), expected, atol=1e-5)
