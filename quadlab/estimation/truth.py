"""The estimator that knows: it hands on the simulator's true state."""

from typing import Literal

from quadlab.configuration import StrictModel, register
from quadlab.estimation.estimate import Estimate, ReadSensors
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState


@register("estimator", "truth")
class TruthEstimator:
    """Ground truth, the reference that every other estimator is compared with."""

    class Config(StrictModel):
        """Selects ground truth; it has no parameters."""

        kind: Literal["truth"]

    sensors = None

    def __init__(self, config: Config, robot: RobotModel, period_s: float, seed: int) -> None:
        self.config = config

    def start(self, read_sensors: ReadSensors, true_state: RobotState) -> Estimate:
        """Return ``true_state`` unchanged."""
        return Estimate(true_state)

    def update(self, read_sensors: ReadSensors, true_state: RobotState) -> Estimate:
        """Return ``true_state`` unchanged."""
        return Estimate(true_state)
