"""Method, formulation and certificate are choices; the torques are the same."""

import math

import numpy as np
import pytest
import qpsolvers
from controller_cases import robot_named, standing_schedule, uniform_plan, with_loads
from preset_cases import near_rest, preset, resolved
from pydantic import ValidationError

from quadlab.controllers.hierarchical import HierarchicalResolver
from quadlab.controllers.tracking_controller import build_controller
from quadlab.robots.model import RobotModel

STANCES = ([0, 1, 2, 3], [0, 1, 3], [1, 2])
on_feet = pytest.mark.parametrize("stance", STANCES, ids=str)


@on_feet
@pytest.mark.parametrize("name", ["hierarchical", "weighted"])
@pytest.mark.parametrize("formulation", ["accelerations_torques", "accelerations_forces"])
def test_formulations_give_the_same_torques(robot: RobotModel, name: str, formulation: str, stance: list[int]) -> None:
    tick = near_rest(robot, stance)
    reduced = resolved(preset(name), *tick)
    full = resolved(preset(name, f"formulation={formulation}"), *tick)
    assert full.solved
    assert tuple(full.residuals) == ("dynamics", "contacts", *reduced.residuals)
    scale = max(1.0, float(np.abs(reduced.torques).max()))
    np.testing.assert_allclose(full.torques, reduced.torques, atol=1e-4 * scale)
    np.testing.assert_allclose(full.contact_forces, reduced.contact_forces, atol=1e-3 * scale)


@on_feet
@pytest.mark.parametrize("name", ["hierarchical", "bellicoso2016", "gehring2017"])
@pytest.mark.parametrize("qp_solver", ["daqp", "piqp"])
def test_the_cascade_gives_the_same_torques_or_says_that_it_failed(
    robot: RobotModel, name: str, qp_solver: str, stance: list[int]
) -> None:
    tick = near_rest(robot, stance)
    ours = resolved(preset(name), *tick)
    printed = resolved(preset(name, "method=cascade", f"qp_solver={qp_solver}"), *tick)
    if printed.solved:
        scale = max(1.0, float(np.abs(ours.torques).max()))
        np.testing.assert_allclose(printed.torques, ours.torques, atol=2e-2 * scale)
        for level, norm in ours.residuals.items():
            assert printed.residuals[level] == pytest.approx(norm, rel=1e-2, abs=1e-2)


@pytest.mark.parametrize("name", ["hierarchical", "bellicoso2016", "gehring2017"])
@pytest.mark.parametrize("qp_solver", ["daqp", "piqp"])
def test_the_cascade_solves_nearly_every_quiet_tick(name: str, qp_solver: str) -> None:
    robot = robot_named("anymal_b")
    config = preset(name, "method=cascade", f"qp_solver={qp_solver}")
    solved = [resolved(config, *near_rest(robot, stance, seed)).solved for seed in range(6) for stance in STANCES]
    assert np.mean(solved) > 0.8


@on_feet
@pytest.mark.parametrize("name", ["hierarchical", "bellicoso2016", "gehring2017", "weighted"])
def test_every_tick_can_be_certified(robot: RobotModel, name: str, stance: list[int]) -> None:
    tick = near_rest(robot, stance, seed=2, size=1.0)
    certified = resolved(preset(name, "certify=true"), *tick)
    assert certified.certificate < 1e-6
    plain = resolved(preset(name), *tick)
    assert math.isnan(plain.certificate)
    assert plain.torques.tobytes() == certified.torques.tobytes(), "the proof does not change what is proved"


@pytest.mark.parametrize("certify", [True, False])
def test_telemetry_carries_the_certificate(robot: RobotModel, certify: bool) -> None:
    controller = build_controller(preset("hierarchical", f"certify={str(certify).lower()}"), robot)
    state = with_loads(robot, robot.nominal_state())
    controller.start(uniform_plan(robot, standing_schedule()), state)
    certificate = controller.tick(state)[1].certificate
    assert certificate < 1e-6 if certify else math.isnan(certificate)


@pytest.mark.parametrize("change", [{"method": "guess"}, {"qp_solver": "abacus"}, {"formulation": "full"}], ids=str)
def test_unknown_choices_are_refused(change: dict[str, str]) -> None:
    with pytest.raises(ValidationError, match=next(iter(change))):
        HierarchicalResolver.Config.model_validate({**preset("hierarchical").model_dump(), **change})


def test_a_back_end_that_is_not_installed_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(qpsolvers, "available_solvers", ["daqp"])
    with pytest.raises(ValidationError, match="osqp is not installed; installed: daqp"):
        HierarchicalResolver.Config.model_validate({**preset("hierarchical").model_dump(), "qp_solver": "osqp"})
