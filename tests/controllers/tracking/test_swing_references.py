"""References of the feet in the air: to the planned foothold, with the robot, against a push, down in search."""

import math
from dataclasses import replace

import numpy as np
import pytest
from controller_cases import moved_state, tracking_config, uniform_plan
from tracking_cases import PERIOD, SWING, TROT, track, tracker_for

from quadlab.controllers.telemetry import LegMode
from quadlab.controllers.tracking.alignment import PlanarPose, identity_alignment
from quadlab.controllers.tracking.contact_machine import start_contacts
from quadlab.controllers.tracking.feet import FootPlanner
from quadlab.estimation.terrain_plane import TerrainPlane, fit_plane
from quadlab.geometry.rotations import Array, rotation_2d
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState

BASE_HEIGHT = 0.5  # [m] the unit of lengths of the swing


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


def test_foot_passes_its_apex_in_the_middle_of_the_swing(robot: RobotModel) -> None:
    standing_height = float(robot.nominal_state().position_base_in_world[2])
    swing = TROT.swings[0][0]
    tracker = tracker_for(robot, uniform_plan(robot, TROT), robot.nominal_state(), swing={"apex": 0.2})
    middle = track(tracker, robot.nominal_state(), 0.6, swing.start_s + 0.5 * swing.duration_s).reference
    assert middle.foot_positions[0, 2] == pytest.approx(0.2 * standing_height, rel=1e-3)
    assert abs(middle.foot_velocities[0, 2]) < 0.02


def test_slower_plan_is_the_same_way_with_the_derivatives_of_a_slower_clock(robot: RobotModel) -> None:
    kinematics, plan = robot.kinematics(robot.nominal_state()), uniform_plan(robot, TROT, (0.1, 0.0))
    feet = FootPlanner(tracking_config().swing, 0.5, 0.5, robot.nominal_feet_in_com, plan.footholds)
    contacts = start_contacts(tracking_config().contact, TROT, 1.0, kinematics.foot_positions)
    contacts.update(SWING, PERIOD, kinematics.foot_positions, np.ones(4))
    terrain = fit_plane(kinematics.foot_positions, np.zeros(2))
    place = (identity_alignment(), np.zeros(2), kinematics, terrain)
    usual, slow = (feet.motions(contacts.legs, SWING + 0.1, clock, *place) for clock in ((1.0, 0.0), (0.4, -0.7)))
    assert np.isfinite(usual[:, [0, 3]]).all()
    np.testing.assert_allclose(slow[0], usual[0])
    np.testing.assert_allclose(slow[1], 0.4 * usual[1])
    np.testing.assert_allclose(slow[2], 0.4**2 * usual[2] - 0.7 * usual[1])


AS_PLANNED, LEVEL = identity_alignment(), TerrainPlane((0.0, 0.0), 0.0, (0.0, 0.0))


def at_touch_down(
    robot: RobotModel,
    state: RobotState,
    footholds: Array,
    alignment: PlanarPose = AS_PLANNED,
    terrain: TerrainPlane = LEVEL,
    too_fast: tuple[float, float] = (0.0, 0.0),
) -> Array:
    """Where LF and RH, which swing to ``footholds`` (4, 3) of the plan, are at the end of the swing, (2, 3) in [m].

    The CoM is ``too_fast`` in [m/s].
    """
    kinematics, config = robot.kinematics(state), tracking_config()
    planned = tuple(np.stack([foot, foot]) for foot in footholds)
    planner = FootPlanner(config.swing, BASE_HEIGHT, 0.5, robot.nominal_feet_in_com, planned)
    contacts = start_contacts(config.contact, TROT, 1.0, kinematics.foot_positions)
    contacts.update(SWING, PERIOD, kinematics.foot_positions, np.ones(4))
    velocity, end_s = kinematics.com_velocity[:2] - too_fast, TROT.swings[0][0].end_s
    return planner.motions(contacts.legs, end_s, (1.0, 0.0), alignment, velocity, kinematics, terrain)[0, [0, 3]]


@pytest.mark.parametrize("too_fast", [(0.0, 0.0), (0.1, -0.05)])
def test_foothold_lies_where_the_plan_lies_or_brakes_and_just_below_the_sloped_ground(
    robot: RobotModel, too_fast: tuple[float, float]
) -> None:
    """The pendulum is as long as the CoM is high over the ground below it."""
    swing = tracking_config().swing
    alignment = PlanarPose((0.1, -0.2), (1.5, 0.7), 0.6)
    terrain = TerrainPlane((0.3, -0.4), 0.05, (0.2, -0.1))
    state = moved_state(robot.nominal_state(), alignment.origin()[:2], alignment.yaw)
    footholds = robot.kinematics(robot.nominal_state()).foot_positions + np.array([0.05, 0.02, 0.0])
    com = robot.kinematics(state).com_position
    step = swing.feedback * math.sqrt((com[2] - terrain.height_at(com[:2])) / 9.81) * np.array(too_fast)
    landed = at_touch_down(robot, state, footholds, alignment, terrain, too_fast)
    for foot, planned in zip(landed, footholds[[0, 3]], strict=True):
        np.testing.assert_allclose(foot[:2], alignment.position(planned[:2]) + step, atol=1e-9)
        assert foot[2] == pytest.approx(terrain.height_at(foot[:2]) - swing.depth * BASE_HEIGHT)


@pytest.mark.parametrize("far", [(5.0, 5.0), (-5.0, 5.0), (0.0, -5.0)])
def test_foothold_out_of_reach_is_at_the_end_of_the_legs_box_which_turns_with_the_base(
    robot: RobotModel, far: tuple[float, float]
) -> None:
    heading = 0.9
    state = moved_state(robot.nominal_state(), np.array([0.4, -0.3]), heading)
    com, nominal = robot.kinematics(state).com_position[:2], robot.nominal_feet_in_com
    asked = com + (nominal + far) @ rotation_2d(heading).T
    landed = at_touch_down(robot, state, np.column_stack([asked, np.zeros(4)]))
    offsets = (landed[:, :2] - com) @ rotation_2d(heading) - nominal[[0, 3]]
    swing = tracking_config().swing
    half_size = BASE_HEIGHT * np.array([swing.reach_forward, swing.reach_sideways])
    np.testing.assert_allclose(offsets, np.tile(np.sign(far) * half_size, (2, 1)), atol=1e-12)


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


@pytest.mark.parametrize("ground", [0.0, 0.5])
def test_pushed_robot_steps_towards_the_push(robot: RobotModel, ground: float) -> None:
    nominal = robot.nominal_state()
    resting = replace(nominal, position_base_in_world=nominal.position_base_in_world + np.array([0.0, 0.0, ground]))
    pushed = replace(resting, linear_velocity_base_in_world=np.array([0.0, 0.2, 0.0]))
    ends = []
    for state in (resting, pushed):
        tracker = tracker_for(robot, uniform_plan(robot, TROT), resting)
        ends.append(track(tracker, state, 0.6, TROT.swings[0][0].end_s - PERIOD).reference.foot_positions)
    height = robot.kinematics(pushed).com_position[2] - ground
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
