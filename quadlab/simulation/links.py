"""Where the links of the URDF are in the simulator's model."""

from dataclasses import dataclass

import pinocchio as pin

from quadlab.geometry.rotations import Array, matrix_to_quat
from quadlab.robots.model import RobotModel


@dataclass(frozen=True)
class LinkPlacement:
    """Where a link of the URDF is in the simulator's model, which joins links without a joint between them.

    Attributes:
        body: name of the body that carries the link.
        position: of the link's frame in the body's frame, (3,) in [m].
        quat_wxyz: link to body, (4,).
    """

    body: str
    position: Array
    quat_wxyz: Array


def link_placements(robot: RobotModel) -> dict[str, LinkPlacement]:
    """Return, for every link of the URDF, the body that carries it and its pose there."""
    model = robot.pin_model
    frames = [frame for frame in model.frames if frame.type == pin.FrameType.BODY]
    carriers: dict[int, str] = {}
    for frame in frames:
        carriers.setdefault(frame.parentJoint, frame.name)
    return {
        frame.name: LinkPlacement(
            carriers[frame.parentJoint],
            frame.placement.translation.copy(),
            matrix_to_quat(frame.placement.rotation),
        )
        for frame in frames
    }
