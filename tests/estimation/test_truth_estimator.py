"""The estimator that knows hands on the true state."""

from estimation_cases import PERIOD, robot_named

from quadlab.configuration import part_of
from quadlab.estimation.truth import TruthEstimator
from quadlab.robots.sensing import SensorReading


def no_sensors() -> SensorReading:
    raise AssertionError("the truth needs no sensors")


def test_truth_is_handed_on_unchanged_without_reading_a_sensor() -> None:
    robot = robot_named("anymal_b")
    state = robot.nominal_state()
    estimator = TruthEstimator(TruthEstimator.Config(kind="truth"), robot, PERIOD, 0)
    assert estimator.start(no_sensors, state).state is state
    assert estimator.update(no_sensors, state).state is state


def test_truth_is_selected_by_its_kind() -> None:
    assert part_of("estimator", TruthEstimator.Config(kind="truth")) is TruthEstimator
