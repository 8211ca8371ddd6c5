"""What moves in the 3-D view: frames, joints, forces, and measured against desired motion."""

from collections.abc import Sequence

import numpy as np
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.JointState_pb2 import JointState
from foxglove_schemas_protobuf.JointStates_pb2 import JointStates
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from quadlab.controllers.telemetry import ControlTelemetry, LegMode
from quadlab.geometry.rotations import Array
from quadlab.robots.legs import JOINT_NAMES, LEGS
from quadlab.trials.recording.primitives import (
    LEG_COLOURS,
    Rgba,
    entity,
    force_arrow,
    polyline,
    quaternion,
    sphere,
    stamp,
    vector,
)
from quadlab.trials.recording.record import BodyPoses, TickRecord
from quadlab.trials.recording.topics import PLAN_FRAME, WORLD_FRAME

_VISIBLE_FORCE = 1.0  # [N]
_MARK, _LINE = 0.03, 0.006  # [m]
_PUSH_COLOUR: Rgba = (0.90, 0.10, 0.10, 1.0)
_MEASURED_COLOUR: Rgba = (0.10, 0.10, 0.10, 1.0)
_DESIRED_COLOUR: Rgba = (0.95, 0.75, 0.10, 1.0)
_SUPPORT_COLOUR: Rgba = (0.10, 0.60, 0.90, 1.0)
_AROUND = tuple(LEGS.index(leg) for leg in ("LF", "RF", "RH", "LH"))


def transforms(tick: TickRecord, bodies: BodyPoses, time_ns: int) -> FrameTransforms:
    """Return the pose in the world of every body and of the plan frame."""
    rows = zip(bodies.names, bodies.positions_in_world.tolist(), bodies.quats_wxyz.tolist(), strict=True)
    found = [_transform(name, position, quat, time_ns) for name, position, quat in rows]
    x, y, yaw = tick.telemetry.plan_pose_in_world.tolist()
    quat_plan = [float(np.cos(0.5 * yaw)), 0.0, 0.0, float(np.sin(0.5 * yaw))]
    return FrameTransforms(transforms=[*found, _transform(PLAN_FRAME, [x, y, 0.0], quat_plan, time_ns)])


def joint_states(tick: TickRecord, time_ns: int) -> JointStates:
    """Return positions in [rad], velocities in [rad/s] and applied torques in [N m] of the joints by name."""
    positions, velocities = tick.state.joint_positions.tolist(), tick.state.joint_velocities.tolist()
    rows = zip(JOINT_NAMES, positions, velocities, tick.command.torques.tolist(), strict=True)
    joints = [JointState(name=name, position=p, velocity=v, effort=t) for name, p, v, t in rows]
    return JointStates(timestamp=stamp(time_ns), joints=joints)


def forces(tick: TickRecord, time_ns: int) -> SceneUpdate:
    """Return arrows for the measured contact forces, in the legs' colours, and for the pushes."""
    scene = entity("forces", WORLD_FRAME, time_ns)
    measured = tick.state.foot_forces_in_world
    shown = [leg for leg in range(len(LEGS)) if np.linalg.norm(measured[leg]) > _VISIBLE_FORCE]
    scene.arrows.extend(
        force_arrow(tick.telemetry.foot_positions[leg], measured[leg], LEG_COLOURS[leg]) for leg in shown
    )
    visible = [(point, force) for point, force in tick.pushes if np.linalg.norm(force) > _VISIBLE_FORCE]
    scene.arrows.extend(force_arrow(point, force, _PUSH_COLOUR) for point, force in visible)
    return SceneUpdate(entities=[scene])


def reference(tick: TickRecord, time_ns: int) -> SceneUpdate:
    """Return CoM and CoP, measured (dark) and desired (yellow), and the support polygon of the standing feet."""
    telemetry = tick.telemetry
    scene = entity("reference", WORLD_FRAME, time_ns)
    scene.spheres.append(sphere(telemetry.com_position, _MARK, _MEASURED_COLOUR))
    scene.spheres.append(sphere(telemetry.com_position_reference, _MARK, _DESIRED_COLOUR))
    scene.spheres.append(sphere(_on_terrain(telemetry.cop_reference, telemetry), _MARK, _DESIRED_COLOUR))
    cop = centre_of_pressure(telemetry.foot_positions, tick.state.foot_forces_in_world)
    if cop is not None:
        scene.spheres.append(sphere(cop, _MARK, _MEASURED_COLOUR))
    corners = [telemetry.foot_positions[leg] for leg in _AROUND if telemetry.leg_modes[leg] == LegMode.STANCE]
    if len(corners) >= 2:
        scene.lines.append(polyline(corners, _LINE, _SUPPORT_COLOUR, closed=True))
    return SceneUpdate(entities=[scene])


def centre_of_pressure(foot_positions: Array, foot_forces: Array) -> Array | None:
    """Return the mean of ``foot_positions`` (4, 3), weighted by the vertical forces (4, 3); None in flight."""
    loads = np.maximum(foot_forces[:, 2], 0.0)
    total = float(loads.sum())
    return loads @ foot_positions / total if total > _VISIBLE_FORCE else None


def _on_terrain(point_xy: Array, telemetry: ControlTelemetry) -> Array:
    height, slope_x, slope_y = telemetry.terrain_plane
    x, y = point_xy - telemetry.com_position[:2]
    return np.array([point_xy[0], point_xy[1], height + slope_x * x + slope_y * y])


def _transform(child: str, position: Sequence[float], quat_wxyz: Sequence[float], time_ns: int) -> FrameTransform:
    return FrameTransform(
        timestamp=stamp(time_ns),
        parent_frame_id=WORLD_FRAME,
        child_frame_id=child,
        translation=vector(position),
        rotation=quaternion(quat_wxyz),
    )
