"""The controller interface."""

from typing import Protocol

from quadlab.controllers.telemetry import ControlTelemetry
from quadlab.controllers.tracking.handover import PlanProgress
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

    @property
    def limit_names(self) -> tuple[str, ...]:
        """Those of ``level_names`` that no tick should leave unmet: limits of torques and contact forces."""
        ...

    def start(self, plan: MotionPlan, state: RobotState) -> None:
        """Begin to follow ``plan``, whose time 0 is the time of ``state``."""
        ...

    def progress(self, state: RobotState) -> PlanProgress:
        """Return how far the plan has been followed: what a new plan has to begin from."""
        ...

    def replace_plan(self, plan: MotionPlan, state: RobotState) -> None:
        """Go on with ``plan``, made from the ``progress`` at ``state``; contacts and terrain are kept."""
        ...

    def tick(self, state: RobotState) -> tuple[JointCommand, ControlTelemetry]:
        """Return torques for the next control period, and what was done to find them."""
        ...
