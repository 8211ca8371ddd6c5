"""What an estimator hands on, and the interface of all estimators."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeAlias

from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.robots.sensing import SensorConfig, SensorReading
from quadlab.robots.state import RobotState


@dataclass(frozen=True)
class FilterReport:
    """What a filter says about itself in one tick.

    Attributes:
        accelerometer_bias, gyro_bias: estimated, (3,) in [m/s^2] and [rad/s].
        contacts: feet that are in contact, (4,).
        used: feet whose position was used as a measurement, (4,); of those in contact the others were outliers, or
            have just landed.
        position_std, velocity_std: standard deviations along the world's axes, (3,) in [m] and [m/s].
        orientation_std: of the rotation about the world's axes, (3,) in [rad].
        innovation_squared: normalised innovation squared of the used feet, summed over feet; for a consistent filter
            chi-square distributed with ``innovation_size`` degrees of freedom.
        innovation_size: 3 for each used foot.
        outliers: measurements of feet refused so far.
        update_us: computing time of the tick in [us].
    """

    accelerometer_bias: Array
    gyro_bias: Array
    contacts: BoolArray
    used: BoolArray
    position_std: Array
    velocity_std: Array
    orientation_std: Array
    innovation_squared: float
    innovation_size: int
    outliers: int
    update_us: float


@dataclass(frozen=True)
class Estimate:
    """The state that the controller is given.

    Attributes:
        state: believed state of the robot.
        report: of the filter; None for the truth.
    """

    state: RobotState
    report: FilterReport | None = None


ReadSensors: TypeAlias = Callable[[], SensorReading]
"""Reads the sensors, once a control tick."""


class Estimator(Protocol):
    """From sensor readings to states, one a control tick; made with (config, robot, period in [s], seed)."""

    sensors: SensorConfig | None
    """How good the sensors are that it is given; None for sensors without errors."""

    def start(self, read_sensors: ReadSensors, true_state: RobotState) -> Estimate:
        """Return the first estimate; ``true_state`` defines the world frame."""
        ...

    def update(self, read_sensors: ReadSensors, true_state: RobotState) -> Estimate:
        """Return the estimate at the next reading; only the truth may use ``true_state``."""
        ...
