"""What is recorded of one tick of a trial."""

from dataclasses import dataclass
from typing import NamedTuple

from quadlab.controllers.telemetry import ControlTelemetry
from quadlab.estimation.estimate import Estimate
from quadlab.geometry.rotations import Array
from quadlab.robots.state import JointCommand, RobotState


class TickRecord(NamedTuple):
    """One control tick.

    Attributes:
        state: true state of the robot at the start of the tick.
        command: torques applied during the tick.
        telemetry: what the controller says about the tick.
        pushes: external forces during the tick as (point (3,) in [m], force (3,) in [N]), both in world components.
        estimate: that the controller was given; None if it is not known.
    """

    state: RobotState
    command: JointCommand
    telemetry: ControlTelemetry
    pushes: tuple[tuple[Array, Array], ...] = ()
    estimate: Estimate | None = None


@dataclass(frozen=True)
class BodyPoses:
    """Where the bodies of the robot are, for drawing.

    Attributes:
        names: names of the bodies, (n,).
        positions_in_world: origins of their frames, (n, 3) in [m].
        quats_wxyz: unit quaternions that turn body components into world components, (n, 4).
    """

    names: tuple[str, ...]
    positions_in_world: Array
    quats_wxyz: Array
