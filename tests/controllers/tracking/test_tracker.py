"""From plan and state to references: alignment, terrain, contacts and the plan's clock at work together."""

import math
from dataclasses import replace

import numpy as np
import pytest
from contact_scripts import one_leg_schedule
from controller_cases import moved_state, standing_schedule, uniform_plan
from tracking_cases import PERIOD, SWING, TROT, track, tracker_for

from quadlab.controllers.telemetry import LegMode
from quadlab.estimation.terrain_plane import fit_plane
from quadlab.geometry.rotations import euler_zyx, matrix_to_quat, rotation_2d, rotation_z, rotation_zyx, yaw_of
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState


@pytest.mark.parametrize("torso", ["none", "base", "feet"])
@pytest.mark.parametrize("swing", ["none", "base", "feet"])
def test_robot_where_it_was_planned_gets_the_plan(robot: RobotModel, torso: str, swing: str) -> None:
    plan = uniform_plan(robot, standing_schedule(), (0.3, -0.1))
    state = robot.nominal_state()
    tracker = tracker_for(robot, plan, state, alignment={"torso": torso, "swing": swing})
    reference = track(tracker, state, 0.0, 0.0).reference
    np.testing.assert_allclose(reference.com_position, plan.at(0.0).com_position[:2], atol=1e-12)
    np.testing.assert_allclose(reference.com_velocity, [0.3, -0.1], atol=1e-12)
    np.testing.assert_allclose(reference.base_rotation, np.eye(3), atol=1e-9)
    np.testing.assert_allclose(reference.ground_axes, np.eye(3), atol=1e-9)
    assert reference.base_height == pytest.approx(float(state.position_base_in_world[2]))
    assert reference.stance.all()
    assert reference.weight == pytest.approx(robot.mass * 9.81)


@pytest.mark.parametrize("torso", ["base", "feet"])
def test_plan_follows_a_displaced_robot(robot: RobotModel, torso: str) -> None:
    """Robot shifted and turned as a whole after planning: the references come to lie where the robot is.

    A base-centred plan that moves on runs ahead of a robot that does not by its speed times the filter's time constant.
    """
    shift, yaw = np.array([0.2, -0.3]), 0.5
    plan = uniform_plan(robot, standing_schedule(), (0.1, 0.0))
    state = moved_state(robot.nominal_state(), shift, yaw)
    tracker = tracker_for(robot, plan, state, alignment={"torso": torso, "swing": "base", "time_constant_s": 0.02})
    tick = track(tracker, state, 0.0, 0.3)
    planned = plan.at(tick.plan_time_s).com_position[:2]
    expected = rotation_2d(yaw) @ planned + shift if torso == "feet" else robot.kinematics(state).com_position[:2]
    np.testing.assert_allclose(tick.reference.com_position, expected, atol=0.1 * 0.02)
    np.testing.assert_allclose(tick.reference.com_velocity, rotation_2d(yaw) @ [0.1, 0.0], atol=1e-4)
    assert yaw_of(tick.reference.base_rotation) == pytest.approx(yaw, abs=1e-4)
    np.testing.assert_allclose(tick.reference.ground_axes, rotation_z(yaw), atol=1e-4)


def test_unaligned_plan_stays_where_it_was_made(robot: RobotModel) -> None:
    plan = uniform_plan(robot, standing_schedule(), (0.3, 0.0))
    state = moved_state(robot.nominal_state(), np.array([0.2, -0.3]), 0.5)
    tracker = tracker_for(robot, plan, state, alignment={"torso": "none", "swing": "none"})
    tick = track(tracker, state, 0.0, 0.3)
    np.testing.assert_allclose(tick.reference.com_position, plan.at(0.3).com_position[:2], atol=1e-12)
    assert yaw_of(tick.reference.base_rotation) == pytest.approx(0.0, abs=1e-12)


def on_a_slope(robot: RobotModel, pitch: float, roll: float) -> RobotState:
    """The nominal stance turned about the world's origin."""
    rotation, nominal = rotation_zyx(0.0, pitch, roll), robot.nominal_state()
    return replace(
        nominal,
        position_base_in_world=rotation @ nominal.position_base_in_world,
        quat_wxyz=matrix_to_quat(rotation),
    )


@pytest.mark.parametrize(("pitch", "roll"), [(-0.2, 0.0), (0.15, 0.0), (0.0, 0.2)])
def test_torso_follows_a_share_of_the_slope_under_the_feet(robot: RobotModel, pitch: float, roll: float) -> None:
    state = on_a_slope(robot, pitch, roll)
    tracker = tracker_for(robot, uniform_plan(robot, standing_schedule()), state, torso={"slope_following": 0.5})
    tick = track(tracker, state, 0.0, 0.0)
    np.testing.assert_allclose(tick.terrain.slope, [math.tan(-pitch), math.tan(roll)], atol=1e-3)
    _, pitch_reference, roll_reference = euler_zyx(tick.reference.base_rotation)
    assert math.tan(pitch_reference) == pytest.approx(0.5 * math.tan(pitch), abs=1e-3)
    assert math.tan(roll_reference) == pytest.approx(0.5 * math.tan(roll), abs=1e-3)
    np.testing.assert_allclose(tick.reference.ground_axes[:, 2], tick.terrain.normal)
    under_base = fit_plane(robot.kinematics(state).foot_positions, state.position_base_in_world[:2]).height
    standing_height = float(robot.nominal_state().position_base_in_world[2])
    assert tick.reference.base_height == pytest.approx(under_base + standing_height)


def test_base_keeps_its_height_over_the_ground_under_it(robot: RobotModel) -> None:
    standing_height = float(robot.nominal_state().position_base_in_world[2])
    nominal, shift = robot.nominal_state(), np.array([0.3, 0.1, 0.25])
    lifted = replace(nominal, position_base_in_world=nominal.position_base_in_world + shift)
    tracker = tracker_for(robot, uniform_plan(robot, standing_schedule()), lifted)
    assert track(tracker, lifted, 0.0, 0.0).reference.base_height == pytest.approx(standing_height + 0.25)


def test_terrain_follows_the_feet_with_its_time_constant(robot: RobotModel) -> None:
    """All feet found 0.1 m higher than they were: after one time constant 1 / e of the step is left."""
    nominal = robot.nominal_state()
    raised = replace(nominal, position_base_in_world=nominal.position_base_in_world + np.array([0.0, 0.0, 0.1]))
    plan = uniform_plan(robot, standing_schedule())
    tracker = tracker_for(robot, plan, nominal, torso={"terrain_time_constant_s": 0.1})
    tick = track(tracker, raised, 0.0, 0.1 - PERIOD)
    assert tick.terrain.height == pytest.approx(0.1 * (1.0 - math.exp(-1.0)), rel=0.02)


def test_acceleration_and_turning_of_the_plan_are_fed_forward_in_the_world(robot: RobotModel) -> None:
    yaw, knots = 0.5, np.array([0.0, 10.0])
    plan = uniform_plan(robot, standing_schedule())
    com = np.array([[plan.com(0.0), [0.1, 0.0, 0.0], [0.2, -0.05, 0.0]]])
    plan = replace(
        plan, com=PiecewisePolynomial(knots, com), heading=PiecewisePolynomial(knots, np.array([[[0.0], [0.3]]]))
    )
    state = moved_state(robot.nominal_state(), np.zeros(2), yaw)
    tracker = tracker_for(robot, plan, state, alignment={"torso": "feet", "time_constant_s": 0.02})
    tick = track(tracker, state, 0.0, 0.5)
    np.testing.assert_allclose(tick.reference.com_acceleration, rotation_2d(yaw) @ [0.4, -0.1], atol=1e-6)
    np.testing.assert_allclose(tick.reference.base_angular_velocity, [0.0, 0.0, 0.3], atol=1e-12)
    assert yaw_of(tick.reference.base_rotation) == pytest.approx(yaw + 0.3 * 0.5)


@pytest.mark.parametrize("freeze", [False, True])
def test_clock_of_the_plan_stops_for_a_late_foot_only_if_told_to(robot: RobotModel, freeze: bool) -> None:
    plan = uniform_plan(robot, TROT, (0.1, 0.0))
    tracker = tracker_for(robot, plan, robot.nominal_state(), contact={"freeze_plan_while_searching": freeze})
    end_s = TROT.swings[0][0].end_s
    track(tracker, robot.nominal_state(), 0.6, end_s - PERIOD)
    late = track(tracker, robot.nominal_state(), end_s, end_s + 0.1, loaded=[1, 2, 3])
    assert late.modes[0] is LegMode.SEARCH
    time_constant_s = math.sqrt(float(robot.nominal_state().position_base_in_world[2]) / 9.81)
    rate = math.exp(-0.1 / time_constant_s) if freeze else 1.0
    waited_s = 0.1 - time_constant_s * (1.0 - rate) if freeze else 0.0
    assert late.plan_time_s == pytest.approx(end_s + 0.1 - waited_s, abs=2 * PERIOD)
    assert np.linalg.norm(late.reference.com_velocity) == pytest.approx(0.1 * rate, rel=0.03)
    brake = 0.1 * rate / time_constant_s if freeze else 0.0
    assert np.linalg.norm(late.reference.com_acceleration) == pytest.approx(brake, rel=0.03)


def test_references_of_a_plan_that_waits_are_those_of_a_slower_clock(robot: RobotModel) -> None:
    """By the chain rule: velocities times the rate r, accelerations times r^2, and r_dot times the velocities."""
    knots, plan = np.array([0.0, TROT.duration_s]), uniform_plan(robot, TROT)
    com = np.array([[plan.com(0.0), [0.1, 0.0, 0.0], [0.2, -0.05, 0.0]]])
    heading = PiecewisePolynomial(knots, np.array([[[0.0], [0.3]]]))
    plan = replace(plan, com=PiecewisePolynomial(knots, com), heading=heading)
    settings = {"alignment": {"torso": "none"}, "contact": {"freeze_plan_while_searching": True}}
    tracker, end_s = tracker_for(robot, plan, robot.nominal_state(), **settings), TROT.swings[0][0].end_s
    track(tracker, robot.nominal_state(), 0.6, end_s - PERIOD)
    late = track(tracker, robot.nominal_state(), end_s, end_s + 0.1, loaded=[1, 2, 3])
    time_constant_s, sample = math.sqrt(robot.nominal_com_height / 9.81), late.sample
    rate = math.exp(-0.1 / time_constant_s)
    np.testing.assert_allclose(late.reference.com_velocity, rate * sample.com_velocity[:2], rtol=0.02)
    np.testing.assert_allclose(late.reference.base_angular_velocity, [0.0, 0.0, 0.3 * rate], rtol=0.02)
    change = rate**2 * sample.com_acceleration - rate / time_constant_s * sample.com_velocity
    np.testing.assert_allclose(late.reference.com_acceleration, change[:2], rtol=0.02)


def test_force_limits_fall_before_lift_off_and_rise_after_touch_down(robot: RobotModel) -> None:
    tracker = tracker_for(robot, uniform_plan(robot, TROT), robot.nominal_state())
    weight = robot.mass * 9.81
    lift_off_s, touch_down_s = TROT.swings[0][0].start_s, TROT.swings[0][0].end_s
    before = track(tracker, robot.nominal_state(), 0.6, lift_off_s - PERIOD).reference
    assert np.all(before.normal_force_limits[[0, 3]] < weight)
    np.testing.assert_allclose(before.normal_force_limits[[1, 2]], 2.0 * weight)
    landing = track(tracker, robot.nominal_state(), lift_off_s, touch_down_s).reference
    assert landing.stance.all()
    np.testing.assert_allclose(landing.normal_force_limits[[0, 3]], 0.1 * weight, rtol=1e-6)
    later = track(tracker, robot.nominal_state(), touch_down_s + PERIOD, touch_down_s + 0.02).reference
    np.testing.assert_allclose(later.normal_force_limits[[0, 3]], 2.0 * weight)


@pytest.mark.parametrize(("towards", "mode"), [(1.0, LegMode.STANCE), (-1.0, LegMode.SWING)])
def test_leg_stays_down_while_the_robot_falls_towards_it(robot: RobotModel, towards: float, mode: LegMode) -> None:
    """LF is to swing from 0.2 s on; a robot that falls the other way can spare it."""
    leg = robot.nominal_feet_in_com[0]
    velocity = 0.3 * towards * leg / np.linalg.norm(leg)  # [m/s]
    pushed = replace(robot.nominal_state(), linear_velocity_base_in_world=np.array([*velocity, 0.0]))
    plan = uniform_plan(robot, one_leg_schedule())
    tracker = tracker_for(robot, plan, robot.nominal_state(), contact={"capture_margin_m": 0.02})
    assert track(tracker, pushed, 0.0, 0.25, loaded=[0, 1, 2, 3]).modes[0] is mode


def test_modes_follow_the_plan(robot: RobotModel) -> None:
    tracker = tracker_for(robot, uniform_plan(robot, TROT), robot.nominal_state())
    tick = track(tracker, robot.nominal_state(), 0.6, SWING)
    assert tick.modes == (LegMode.SWING, LegMode.STANCE, LegMode.STANCE, LegMode.SWING)
    assert tick.reference.stance_legs == [1, 2]
    assert tick.reference.swing_legs == [0, 3]
    np.testing.assert_array_equal(tick.sample.contacts, tick.reference.stance)
    assert tick.events == ()
