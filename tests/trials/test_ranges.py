"""Ranges of a configuration that nothing can lie in, and names that are taken, are refused before a trial starts."""

import pytest

from quadlab.errors import ConfigurationError
from quadlab.trials.compose import compose_trial


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (
            ["controller=bellicoso2016", "controller.levels.4.tasks.0.minimum=1.2"],
            "minimum must be below maximum; are 1.2 and 1.06",
        ),
        (
            ["estimator=ekf", "estimator.contact.lift_off_share=0.5"],
            "lift_off_share must not be above touch_down_share; are 0.5 and",
        ),
        (
            ["controller.tracking.force_ramp.initial_weight_share=5"],
            "initial_weight_share must not be above maximum_weight_share; are 5 and 2",
        ),
        (["scenario=step_down", "scenario.terrain.0.height_m=0"], "scenario.terrain[0].height_m"),
        (["scenario=step_down", "scenario.terrain.0.height_m=0.0"], "must be above or below 0; level ground"),
        (["scenario=slope", "scenario.terrain.0.angle_deg=0"], "must be above or below 0; level ground"),
        (["scenario=plank", "scenario.terrain.0.height_m=0"], "scenario.terrain[0].height_m"),
        (["scenario=plank", "scenario.terrain.0.length_m=0"], "scenario.terrain[0].length_m"),
        (["scenario=plank", "scenario.terrain.0.width_m=0"], "scenario.terrain[0].width_m"),
        (["controller=projected_inverse_dynamics", "controller.rank_tolerance=10"], "controller.rank_tolerance"),
        (
            ["controller=weighted", "controller.levels.0.name=weighted"],
            "level names weighted are those of the controller's own levels",
        ),
        (
            ["controller.formulation=accelerations_torques", "controller.levels.0.name=dynamics"],
            "level names dynamics are those of the controller's own levels",
        ),
    ],
)
def test_mistake_is_refused_in_one_line(overrides: list[str], message: str) -> None:
    with pytest.raises(ConfigurationError) as caught:
        compose_trial(overrides)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 300, "not all levels once more"
