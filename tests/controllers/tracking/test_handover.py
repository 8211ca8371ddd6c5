"""A plan may be replaced while it is followed: nothing jumps if the new plan is the rest of the old one."""

from dataclasses import replace

import numpy as np
import pytest
from controller_cases import moved_state, standing_schedule, uniform_plan
from tracking_cases import PERIOD, TROT, track, tracker_for

from quadlab.controllers.telemetry import LegMode
from quadlab.controllers.tracking.tracker import MotionTracker
from quadlab.planners.plan import MotionPlan
from quadlab.robots.model import RobotModel

FREE = {"contact": {"lost_contact_s": 10.0}}
"""Robots of these tests do not move, so their swing feet never leave the ground and never load it."""


def rest_of(plan: MotionPlan, cut_s: float) -> MotionPlan:
    """What is left at ``cut_s`` of a plan that does not move: the same footholds, swings over left out."""
    schedule = plan.schedule.after(cut_s)
    footholds = tuple(feet[-1 - len(swings) :] for feet, swings in zip(plan.footholds, schedule.swings, strict=True))
    return replace(plan, schedule=schedule, footholds=footholds)


def followed_to(robot: RobotModel, plan: MotionPlan, cut_s: float) -> MotionTracker:
    tracker = tracker_for(robot, plan, robot.nominal_state(), **FREE)
    track(tracker, robot.nominal_state(), 0.0, cut_s - PERIOD)
    return tracker


@pytest.mark.parametrize("cut_s", [0.4, 0.7, 0.9, 1.3], ids=["standing", "first swing", "late in it", "second swing"])
def test_rest_of_the_plan_gives_the_same_references(robot: RobotModel, cut_s: float) -> None:
    plan, state = uniform_plan(robot, TROT), robot.nominal_state()
    kept, replaced = followed_to(robot, plan, cut_s), followed_to(robot, plan, cut_s)
    replaced.replace_plan(rest_of(plan, cut_s), cut_s, robot.kinematics(state))
    kinematics, weight = robot.kinematics(state), robot.mass * 9.81
    for step in range(200):
        forces = 0.25 * weight * np.array(TROT.contacts_at(cut_s + step * PERIOD), dtype=float)
        expected = kept.update(cut_s + step * PERIOD, kinematics, forces)
        found = replaced.update(step * PERIOD, kinematics, forces)
        assert found.modes == expected.modes
        assert found.plan_time_s == pytest.approx(expected.plan_time_s)
        for name in ("com_position", "base_rotation", "foot_positions", "foot_velocities", "normal_force_limits"):
            np.testing.assert_allclose(
                getattr(found.reference, name), getattr(expected.reference, name), atol=1e-6, err_msg=name
            )


def test_frame_of_the_first_plan_is_remembered(robot: RobotModel) -> None:
    """A robot displaced as a whole: the first plan lies where the feet are, the next one in the world as it is."""
    shift, yaw = np.array([0.2, -0.3]), 0.4
    plan = uniform_plan(robot, standing_schedule())
    state = moved_state(robot.nominal_state(), shift, yaw)
    tracker = tracker_for(robot, plan, state, alignment={"torso": "feet", "swing": "feet", "time_constant_s": 0.02})
    before = track(tracker, state, 0.0, 0.5)
    np.testing.assert_allclose(before.plan_pose_in_world, [*shift, yaw], atol=1e-4)
    here = uniform_plan(robot, standing_schedule(), shift=(0.2, -0.3), yaw=yaw)
    tracker.replace_plan(here, 0.5 + PERIOD, robot.kinematics(state))
    after = track(tracker, state, 0.0, 0.5)
    np.testing.assert_allclose(after.plan_pose_in_world, [*shift, yaw], atol=1e-4)
    np.testing.assert_allclose(after.torso_alignment.origin(), 0.0, atol=1e-4)
    np.testing.assert_allclose(after.reference.com_position, before.reference.com_position, atol=1e-4)
    assert after.plan_time_s == pytest.approx(1.0 + PERIOD)


def test_time_that_the_old_plan_waited_is_no_time_of_the_new_one(robot: RobotModel) -> None:
    plan, state, swing = uniform_plan(robot, TROT), robot.nominal_state(), TROT.swings[0][0]
    tracker = tracker_for(robot, plan, state, contact={"lost_contact_s": 10.0, "freeze_plan_while_searching": True})
    track(tracker, state, 0.0, swing.end_s - PERIOD)
    time_s = swing.end_s + 0.2
    track(tracker, state, swing.end_s, time_s - PERIOD, loaded=[1, 2, 3])
    plan_time_s = tracker.progress(time_s, robot.kinematics(state)).plan_time_s
    assert plan_time_s < time_s - 0.05, "the plan has waited for the late foot"
    tracker.replace_plan(rest_of(plan, plan_time_s), time_s, robot.kinematics(state))
    assert tracker.progress(0.0, robot.kinematics(state)).plan_time_s == pytest.approx(plan_time_s)
    assert track(tracker, state, 0.0, 0.0).plan_time_s == pytest.approx(plan_time_s, abs=PERIOD)


def test_progress_tells_what_each_foot_does(robot: RobotModel) -> None:
    plan, state = uniform_plan(robot, TROT), robot.nominal_state()
    kinematics, swing = robot.kinematics(state), TROT.swings[0][0]
    tracker = followed_to(robot, plan, swing.start_s + 0.5 * swing.duration_s)
    in_the_air = tracker.progress(swing.start_s + 0.5 * swing.duration_s, kinematics)
    assert in_the_air.standing.tolist() == [False, True, True, False]
    assert in_the_air.regular
    np.testing.assert_allclose(in_the_air.feet, kinematics.foot_positions)
    ahead = robot.kinematics(moved_state(state, np.array([0.1, 0.0]), 0.0))
    feet = tracker.progress(swing.start_s + 0.5 * swing.duration_s, ahead).feet
    np.testing.assert_allclose(feet[[1, 2]], ahead.foot_positions[[1, 2]])
    np.testing.assert_allclose(feet[[0, 3]], kinematics.foot_positions[[0, 3]], err_msg="where they left the ground")
    assert not tracker.progress(swing.end_s + 0.01, kinematics).regular, "in the air, though not by plan"

    touched_s = swing.start_s + 0.8 * swing.duration_s
    track(tracker, state, swing.start_s + 0.5 * swing.duration_s, touched_s, loaded=[0, 1, 2])
    landed = tracker.progress(touched_s + PERIOD, kinematics)
    assert landed.standing.tolist() == [True, True, True, False], "LF touched down early"


def test_leg_that_landed_early_stays_on_the_ground_under_the_new_plan(robot: RobotModel) -> None:
    plan, state, swing = uniform_plan(robot, TROT), robot.nominal_state(), TROT.swings[0][0]
    cut_s = swing.start_s + 0.85 * swing.duration_s
    tracker = followed_to(robot, plan, swing.start_s + 0.6 * swing.duration_s)
    track(tracker, state, swing.start_s + 0.6 * swing.duration_s, cut_s - PERIOD, loaded=[0, 1, 2])
    rest = rest_of(plan, cut_s)
    contacts = rest.schedule.contacts.copy()
    contacts[0, 0] = True
    rest = replace(rest, schedule=replace(rest.schedule, contacts=contacts))
    tracker.replace_plan(rest, cut_s, robot.kinematics(state))
    tick = track(tracker, state, 0.0, 0.5 * (swing.end_s - cut_s), loaded=[0, 1, 2])
    assert tick.modes == (LegMode.STANCE, LegMode.STANCE, LegMode.STANCE, LegMode.SWING)


def test_late_foot_finds_the_first_foothold_of_the_new_plan(robot: RobotModel) -> None:
    plan, state, swing = uniform_plan(robot, TROT), robot.nominal_state(), TROT.swings[0][0]
    tracker = followed_to(robot, plan, swing.start_s)
    late = track(tracker, state, swing.start_s, swing.end_s + 0.01, loaded=[1, 2, 3])
    assert late.modes[0] is LegMode.SEARCH
    cut_s = late.plan_time_s + PERIOD
    assert tracker.progress(cut_s, robot.kinematics(state)).standing[0]
    rest = rest_of(plan, cut_s)
    tracker.replace_plan(rest, cut_s, robot.kinematics(state))
    found = track(tracker, state, 0.0, PERIOD, loaded=[0, 1, 2, 3])
    assert found.modes[0] is LegMode.STANCE
    np.testing.assert_allclose(found.reference.com_position, plan.com(0.0)[:2], atol=1e-6)
    following = rest.schedule.swings[0][0]
    later = track(tracker, state, 2.0 * PERIOD, following.start_s + 0.5 * following.duration_s)
    assert later.modes[0] is LegMode.SWING


def test_feet_that_have_rolled_on_stand_where_the_new_plan_has_them(robot: RobotModel) -> None:
    """By less than a slip, so that nothing has told the old plan."""
    settings = {"alignment": {"torso": "feet", "swing": "feet"}, "contact": {"slip_m": 1.0}}
    tracker = tracker_for(robot, uniform_plan(robot, standing_schedule()), robot.nominal_state(), **settings)
    state = moved_state(robot.nominal_state(), np.array([0.01, -0.02]), 0.0)
    track(tracker, state, 0.0, 0.1)
    here = uniform_plan(robot, standing_schedule(), shift=(0.01, -0.02))
    tracker.replace_plan(here, 0.1 + PERIOD, robot.kinematics(state))
    np.testing.assert_allclose(track(tracker, state, 0.0, 0.5).torso_alignment.origin(), 0.0, atol=1e-9)
