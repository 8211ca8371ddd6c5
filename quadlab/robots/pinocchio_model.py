"""A robot's Pinocchio model with the indices that bring its arrays into quadlab's order."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from quadlab.errors import RobotDescriptionError
from quadlab.robots.config import RobotConfig, foot_links_in_urdf, joint_names_in_urdf
from quadlab.robots.legs import JOINT_COUNT, JOINTS_PER_LEG, LEG_COUNT

IndexArray = NDArray[np.intp]


@dataclass(frozen=True)
class PinocchioModel:
    """A free-flying Pinocchio model and the way from its order to quadlab's.

    Attributes:
        model: ``pinocchio.Model`` with a frame at the centre of each foot sphere.
        joint_names: names in the URDF in the order ``JOINT_NAMES``, (12,).
        position_indices: of the joints in Pinocchio's configuration q, (12,).
        velocity_indices: of the joints in Pinocchio's velocity v, (12,).
        order: takes Pinocchio's velocity into the generalised velocity u, (18,): u = v[order].
        foot_frames: ids of the frames at the sphere centres, (4,).
        hip_joints: ids of the HAA joints, (4,).
    """

    model: Any
    joint_names: tuple[str, ...]
    position_indices: IndexArray
    velocity_indices: IndexArray
    order: IndexArray
    foot_frames: tuple[int, ...]
    hip_joints: tuple[int, ...]


def build_pinocchio_model(config: RobotConfig, urdf_text: str) -> PinocchioModel:
    """Build the model of ``urdf_text`` with the names, feet and rotor inertias of ``config``.

    Raises:
        RobotDescriptionError: if the URDF does not have the named links and joints.
    """
    model = pin.buildModelFromXML(urdf_text, pin.JointModelFreeFlyer())
    _check_base(config, model)
    joint_names = joint_names_in_urdf(config)
    joints = [_joint_id(config, model, name) for name in joint_names]
    if model.nv != 6 + JOINT_COUNT:
        raise RobotDescriptionError(f"robot {config.name}: {model.nv - 6} moving joints; expected {JOINT_COUNT}")
    velocity_indices = np.array([model.joints[joint].idx_v for joint in joints], dtype=np.intp)
    armature = np.zeros(model.nv)
    armature[velocity_indices] = np.tile(config.armature_kgm2, LEG_COUNT)
    model.armature = armature
    return PinocchioModel(
        model=model,
        joint_names=joint_names,
        position_indices=np.array([model.joints[joint].idx_q for joint in joints], dtype=np.intp),
        velocity_indices=velocity_indices,
        order=np.concatenate([np.arange(6, dtype=np.intp), velocity_indices]),
        foot_frames=add_foot_frames(config, model),
        hip_joints=tuple(joints[::JOINTS_PER_LEG]),
    )


def add_foot_frames(config: RobotConfig, model: Any) -> tuple[int, ...]:
    """Add a frame at the centre of each foot sphere to a ``pinocchio.Model`` and return their ids, (4,).

    Raises:
        RobotDescriptionError: if the model does not have the named links.
    """
    return tuple(_add_foot_frame(config, model, link) for link in foot_links_in_urdf(config))


def _joint_id(config: RobotConfig, model: Any, name: str) -> int:
    if not model.existJointName(name):
        known = ", ".join(list(model.names)[2:])
        raise RobotDescriptionError(f"robot {config.name}: no moving joint '{name}'; known: {known}")
    return int(model.getJointId(name))


def _check_base(config: RobotConfig, model: Any) -> None:
    bodies = [frame.name for frame in model.frames if frame.type == pin.FrameType.BODY]
    if config.base_link != bodies[0]:
        raise RobotDescriptionError(
            f"robot {config.name}: base_link '{config.base_link}' is not the URDF's root link '{bodies[0]}'"
        )


def _add_foot_frame(config: RobotConfig, model: Any, link: str) -> int:
    bodies = [frame.name for frame in model.frames if frame.type == pin.FrameType.BODY]
    if link not in bodies:
        raise RobotDescriptionError(f"robot {config.name}: no link '{link}'; known: {', '.join(bodies)}")
    foot = model.getFrameId(link, pin.FrameType.BODY)
    center = pin.SE3(np.eye(3), np.array(config.foot_center_m))
    placement = model.frames[foot].placement * center
    frame = pin.Frame(f"{link}_center", model.frames[foot].parentJoint, foot, placement, pin.FrameType.OP_FRAME)
    return int(model.addFrame(frame))
