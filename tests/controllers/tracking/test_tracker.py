"""From plan and state to references: alignment, terrain, swing feet and the plan's clock at work together."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from controller_cases import gait_schedule, moved_state, standing_schedule, tracking_config, uniform_plan

from quadlab.controllers.telemetry import LegMode
from quadlab.controllers.tracking.tracker import MotionTracker, TrackedTick
from quadlab.geometry.rotations import Array, euler_zyx, matrix_to_quat, rotation_2d, rotation_zyx, yaw_of
from quadlab.planners.plan import MotionPlan
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState

PERIOD = 0.0025  # [s]
SWING = 0.675  # [s] a time in the first swing of the shipped trot, in which LF and RH are in the air
TROT = gait_schedule("trot", 2.9)


def tracker_for(robot: RobotModel, plan: MotionPlan, start: RobotState, **changes: Any) -> MotionTracker:
    return MotionTracker(tracking_config(**changes), robot, PERIOD, plan, robot.kinematics(start))


def track(
    tracker: MotionTracker,
    state: RobotState,
    start_s: float,
    end_s: float,
    loaded: Sequence[int] | None = None,
) -> TrackedTick:
    """Last of the ticks over [start_s, end_s] with a robot that does not move, loaded as planned unless said."""
    kinematics, weight = tracker.robot.kinematics(state), tracker.robot.mass * 9.81
    for step in range(round((end_s - start_s) / PERIOD) + 1):
        time = start_s + step * PERIOD
        flags = tracker.plan.schedule.contacts_at(time)
        loads = [flags[leg] if loaded is None else leg in loaded for leg in range(4)]
        tick = tracker.update(time, kinematics, 0.25 * weight * np.array(loads))
    return tick


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


def test_base_keeps_its_height_over_the_ground_under_it(robot: RobotModel) -> None:
    standing_height = float(robot.nominal_state().position_base_in_world[2])
    nominal, shift = robot.nominal_state(), np.array([0.3, 0.1, 0.25])
    lifted = replace(nominal, position_base_in_world=nominal.position_base_in_world + shift)
    tracker = tracker_for(robot, uniform_plan(robot, standing_schedule()), lifted)
    assert track(tracker, lifted, 0.0, 0.0).reference.base_height == pytest.approx(standing_height + 0.25)


def swing_end(robot: RobotModel, state: RobotState, velocity: tuple[float, float], alignment: str) -> Array:
    """References at the end of the first swing, without foothold correction, (4, 3)."""
    plan = uniform_plan(robot, TROT, velocity)
    settings = {"alignment": {"torso": "none", "swing": alignment}, "swing": {"feedback": 0.0}}
    tracker = tracker_for(robot, plan, state, **settings)
    end_s = plan.schedule.swings[0][0].end_s - PERIOD
    return track(tracker, state, 0.6, end_s).reference.foot_positions


def test_swing_ends_at_the_planned_foothold_just_below_the_ground(robot: RobotModel) -> None:
    feet = swing_end(robot, robot.nominal_state(), (0.1, 0.0), "none")
    plan = uniform_plan(robot, TROT, (0.1, 0.0))
    depth = 0.008 * float(robot.nominal_state().position_base_in_world[2])
    for leg in (0, 3):
        np.testing.assert_allclose(feet[leg], plan.footholds[leg][1] - [0.0, 0.0, depth], atol=1e-3)
    assert np.isnan(feet[[1, 2]]).all()


def test_foothold_goes_with_the_displaced_base(robot: RobotModel) -> None:
    """Base-centred: the foothold keeps its place relative to the planned CoM."""
    shift = np.array([0.1, 0.05])
    state = moved_state(robot.nominal_state(), shift, 0.0)
    feet = swing_end(robot, state, (0.1, 0.0), "base")
    plan = uniform_plan(robot, TROT, (0.1, 0.0))
    com = robot.kinematics(state).com_position[:2]
    planned_com = plan.at(plan.schedule.swings[0][0].end_s - PERIOD).com_position[:2]
    for leg in (0, 3):
        np.testing.assert_allclose(feet[leg, :2] - com, plan.footholds[leg][1, :2] - planned_com, atol=1e-3)


def test_pushed_robot_steps_towards_the_push(robot: RobotModel) -> None:
    pushed = replace(robot.nominal_state(), linear_velocity_base_in_world=np.array([0.0, 0.2, 0.0]))
    ends = []
    for state in (robot.nominal_state(), pushed):
        tracker = tracker_for(robot, uniform_plan(robot, TROT), robot.nominal_state())
        ends.append(track(tracker, state, 0.6, TROT.swings[0][0].end_s - PERIOD).reference.foot_positions)
    height = robot.kinematics(pushed).com_position[2]
    step = (ends[1] - ends[0])[[0, 3], :2]
    np.testing.assert_allclose(step, np.tile([0.0, 0.2 * math.sqrt(height / 9.81)], (2, 1)), rtol=0.03, atol=1e-9)


def test_late_foot_is_sent_straight_down_with_the_search_speed(robot: RobotModel) -> None:
    tracker = tracker_for(robot, uniform_plan(robot, TROT), robot.nominal_state(), contact={"search_speed_mps": 0.4})
    end_s = TROT.swings[0][0].end_s
    track(tracker, robot.nominal_state(), 0.6, end_s - PERIOD)
    late = track(tracker, robot.nominal_state(), end_s, end_s + 0.02, loaded=[1, 2, 3])
    start = robot.kinematics(robot.nominal_state()).foot_positions[0]
    assert late.modes == (LegMode.SEARCH, LegMode.STANCE, LegMode.STANCE, LegMode.STANCE)
    reference = late.reference
    np.testing.assert_allclose(reference.foot_positions[0], start - [0.0, 0.0, 0.4 * 0.02], atol=0.4 * 2 * PERIOD)
    np.testing.assert_allclose(reference.foot_velocities[0], [0.0, 0.0, -0.4])


@pytest.mark.parametrize("freeze", [False, True])
def test_clock_of_the_plan_stops_for_a_late_foot_only_if_told_to(robot: RobotModel, freeze: bool) -> None:
    plan = uniform_plan(robot, TROT, (0.1, 0.0))
    tracker = tracker_for(robot, plan, robot.nominal_state(), contact={"freeze_plan_while_searching": freeze})
    end_s = TROT.swings[0][0].end_s
    track(tracker, robot.nominal_state(), 0.6, end_s - PERIOD)
    late = track(tracker, robot.nominal_state(), end_s, end_s + 0.2, loaded=[1, 2, 3])
    assert late.modes[0] is LegMode.SEARCH
    assert late.plan_time_s == pytest.approx(end_s if freeze else end_s + 0.2, abs=2 * PERIOD)
    assert np.linalg.norm(late.reference.com_velocity) == pytest.approx(0.0 if freeze else 0.1)
    assert np.linalg.norm(late.reference.com_acceleration) == pytest.approx(0.0)


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


def test_modes_follow_the_plan(robot: RobotModel) -> None:
    tracker = tracker_for(robot, uniform_plan(robot, TROT), robot.nominal_state())
    tick = track(tracker, robot.nominal_state(), 0.6, SWING)
    assert tick.modes == (LegMode.SWING, LegMode.STANCE, LegMode.STANCE, LegMode.SWING)
    assert tick.reference.stance_legs == [1, 2]
    assert tick.reference.swing_legs == [0, 3]
    np.testing.assert_array_equal(tick.sample.contacts, tick.reference.stance)
    assert tick.events == ()
