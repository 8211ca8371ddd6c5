"""The estimator that knows hands on the true state."""

from quadlab.configuration import part_of
from quadlab.estimation.truth import TruthEstimator
from quadlab.robots.catalogue import robot_config
from quadlab.robots.model import load_robot


def test_truth_is_handed_on_unchanged() -> None:
    state = load_robot(robot_config("anymal_b")).nominal_state()
    assert TruthEstimator(TruthEstimator.Config(kind="truth")).update(state) is state


def test_truth_is_selected_by_its_kind() -> None:
    assert part_of("estimator", TruthEstimator.Config(kind="truth")) is TruthEstimator
