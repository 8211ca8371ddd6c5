"""The estimator that knows: it hands on the simulator's true state."""

from typing import Literal

from quadlab.configuration import StrictModel, register
from quadlab.robots.state import RobotState


@register("estimator", "truth")
class TruthEstimator:
    """Ground truth, the reference that every other estimator is compared with."""

    class Config(StrictModel):
        """Selects ground truth; it has no parameters."""

        kind: Literal["truth"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def update(self, true_state: RobotState) -> RobotState:
        """Return ``true_state`` unchanged."""
        return true_state
