"""The estimator that knows hands on the true state."""

import numpy as np

from quadlab.configuration import part_of
from quadlab.estimation.truth import TruthEstimator
from quadlab.robots.catalogue import robot_config
from quadlab.robots.model import load_robot
from quadlab.robots.sensing import SensorReading


def test_truth_is_handed_on_unchanged() -> None:
    robot = load_robot(robot_config("anymal_b"))
    state, nothing = robot.nominal_state(), np.zeros(12)
    reading = SensorReading(0.0, np.zeros(3), np.zeros(3), nothing, nothing, nothing, np.zeros((4, 3)))
    estimator = TruthEstimator(TruthEstimator.Config(kind="truth"), robot, 0.0025, 0)
    assert estimator.start(reading, state).state is state
    assert estimator.update(reading, state).state is state


def test_truth_is_selected_by_its_kind() -> None:
    assert part_of("estimator", TruthEstimator.Config(kind="truth")) is TruthEstimator
