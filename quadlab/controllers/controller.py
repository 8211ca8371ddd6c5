"""The controller interface."""

from typing import Protocol

from quadlab.controllers.telemetry import ControlTelemetry
from quadlab.planners.plan import MotionPlan
from quadlab.robots.state import JointCommand, RobotState


class Controller(Protocol):
    """What every controller can do; it is made for one robot and follows one plan at a time."""

    @property
    def period_s(self) -> float:
        """Control period in [s]."""
        ...

    @property
    def level_names(self) -> tuple[str, ...]:
        """Names under which telemetry reports residuals, in order of priority."""
        ...

    def start(self, plan: MotionPlan, state: RobotState) -> None:
        """Begin to follow ``plan``, whose time 0 is the time of ``state``."""
        ...

    def tick(self, state: RobotState) -> tuple[JointCommand, ControlTelemetry]:
        """Return torques for the next control period, and what was done to find them."""
        ...
