"""The estimator that knows hands on the true state."""

import numpy as np
from estimation_cases import PERIOD, robot_named

from quadlab.configuration import part_of
from quadlab.estimation.truth import TruthEstimator
from quadlab.robots.sensing import SensorReading


def test_truth_is_handed_on_unchanged() -> None:
    robot = robot_named("anymal_b")
    state = robot.nominal_state()
    reading = SensorReading(0.0, np.ones(3), np.ones(3), np.ones(12), np.ones(12), np.ones(12), np.ones((4, 3)))
    estimator = TruthEstimator(TruthEstimator.Config(kind="truth"), robot, PERIOD, 0)
    assert estimator.start(reading, state).state is state
    assert estimator.update(reading, state).state is state


def test_truth_is_selected_by_its_kind() -> None:
    assert part_of("estimator", TruthEstimator.Config(kind="truth")) is TruthEstimator
