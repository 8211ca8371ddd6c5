"""Drawings are where the numbers say."""

from dataclasses import replace

import numpy as np
import pytest
from synthetic_records import BODIES, body_poses, geoms, motion_plan, tick_record

from quadlab.controllers.telemetry import LegMode
from quadlab.errors import LogError
from quadlab.geometry.rotations import quat_to_matrix
from quadlab.robots.legs import JOINT_NAMES
from quadlab.trials.recording import topics
from quadlab.trials.recording.geom_scene import geom_scene
from quadlab.trials.recording.plan_scene import plan_scene, swing_arc
from quadlab.trials.recording.primitives import FORCE_SCALE, quat_from_x_to
from quadlab.trials.recording.tick_scene import centre_of_pressure, forces, joint_states, reference, transforms

DIRECTIONS = [*np.eye(3), *-np.eye(3), np.array([0.6, -0.64, 0.48])]


@pytest.mark.parametrize("direction", DIRECTIONS, ids=str)
def test_an_arrow_points_along_its_force(direction: np.ndarray) -> None:
    quat = quat_from_x_to(direction)
    np.testing.assert_allclose(quat_to_matrix(quat)[:, 0], direction, atol=1e-12)
    assert np.linalg.norm(quat) == pytest.approx(1.0)


def test_loaded_feet_and_pushes_have_arrows_in_proportion_to_their_force() -> None:
    tick = tick_record(12)
    tick.state.foot_forces_in_world[1] = 0.0
    arrows = forces(tick, 0).entities[0].arrows
    norms = [*np.linalg.norm(tick.state.foot_forces_in_world[[0, 2, 3]], axis=1), 150.0]
    np.testing.assert_allclose([arrow.shaft_length for arrow in arrows], np.array(norms) * FORCE_SCALE)


def test_support_polygon_goes_round_the_standing_feet_only() -> None:
    tick = tick_record(0)
    modes = (LegMode.STANCE, LegMode.STANCE, LegMode.SEARCH, LegMode.STANCE)
    scene = reference(tick._replace(telemetry=tick.telemetry._replace(leg_modes=modes)), 0).entities[0]
    corners = [(point.x, point.y, point.z) for point in scene.lines[0].points]
    np.testing.assert_array_equal(corners, tick.telemetry.foot_positions[[0, 1, 3]])


def test_centre_of_pressure_is_where_the_load_is() -> None:
    feet = np.array([[0.3, 0.2, 0.0], [0.3, -0.2, 0.0], [-0.3, 0.2, 0.0], [-0.3, -0.2, 0.0]])
    loads = np.zeros((4, 3))
    assert centre_of_pressure(feet, loads) is None
    loads[:2, 2] = 100.0
    cop = centre_of_pressure(feet, loads)
    assert cop is not None
    np.testing.assert_allclose(cop, np.array([0.3, 0.0, 0.0]), atol=1e-15)


def test_transforms_hold_every_body_and_the_plan_frame() -> None:
    tick, bodies = tick_record(3), body_poses(3)
    found = {transform.child_frame_id: transform for transform in transforms(tick, bodies, 7).transforms}
    assert set(found) == {*BODIES, topics.PLAN_FRAME}
    base = found["base"]
    assert (base.translation.x, base.rotation.w) == (bodies.positions_in_world[0, 0], bodies.quats_wxyz[0, 0])
    plan = found[topics.PLAN_FRAME].rotation
    heading = quat_to_matrix(np.array([plan.w, plan.x, plan.y, plan.z]))[:, 0]
    yaw = tick.telemetry.plan_pose_in_world[2]
    np.testing.assert_allclose(heading, [np.cos(yaw), np.sin(yaw), 0.0], atol=1e-12)


def test_joint_states_have_the_order_of_the_names() -> None:
    tick = tick_record(3)
    joints = joint_states(tick, 0).joints
    assert tuple(joint.name for joint in joints) == JOINT_NAMES
    np.testing.assert_array_equal([joint.effort for joint in joints], tick.command.torques)


def test_shapes_have_full_edges_and_capsules_have_caps() -> None:
    entities = {entity.frame_id: entity for entity in geom_scene(geoms(), 0).entities}
    assert all(entity.frame_locked for entity in entities.values())
    box, thigh = entities["base"].cubes[0], entities["LF_THIGH"]
    assert (box.size.x, box.size.y, box.size.z) == (0.6, 0.3, 0.2)
    assert (thigh.cylinders[0].size.x, thigh.cylinders[0].size.z) == (0.04, 0.2)
    assert [cap.pose.position.z for cap in thigh.spheres] == [-0.1, 0.1]
    ground = entities["world"].cubes[0]
    assert ground.pose.position.z + 0.5 * ground.size.z == pytest.approx(0.0)
    assert len(entities["base"].triangles[0].indices) == 12


def test_a_mesh_without_faces_is_a_clear_error() -> None:
    mesh = next(geom for geom in geoms() if geom.kind == "mesh")
    with pytest.raises(LogError, match="needs vertices"):
        geom_scene([replace(mesh, faces=None)], 0)


def test_plan_shows_every_foothold_and_joins_them_by_arcs() -> None:
    plan = motion_plan()
    motion, *legs = plan_scene(plan, 0).entities
    assert [len(leg.spheres) for leg in legs] == [len(footholds) for footholds in plan.footholds]
    assert [len(leg.lines) for leg in legs] == [len(footholds) - 1 for footholds in plan.footholds]
    end, last = plan.com(plan.duration_s), motion.lines[0].points[-1]
    np.testing.assert_allclose([last.x, last.y, last.z], end)


def test_a_swing_arc_begins_and_ends_at_its_footholds_and_lifts_the_foot() -> None:
    start, end = np.array([0.0, 0.1, 0.02]), np.array([0.3, 0.12, 0.06])
    arc = swing_arc(start, end)
    np.testing.assert_allclose(arc[[0, -1]], [start, end], atol=1e-15)
    assert (arc[1:-1, 2] > start[2]).all()
