"""A composer gives what Hydra gives, and reads files that many trials share once."""

import pytest
from omegaconf import DictConfig, OmegaConf

from quadlab.errors import ConfigurationError
from quadlab.trials import composer as composer_module
from quadlab.trials.compose import compose_document
from quadlab.trials.composer import Composer


@pytest.mark.parametrize(
    "overrides",
    [
        [],
        ["gait=walk", "seed=3", "seed=4"],
        ["gait.cycles.0.stride_duration_s=1.1", "gait=walk", "tag=x"],
        ["scenario=push", "scenario.pushes.0.direction=[-1,0,0]", "replanning.period_s=null"],
        ["experiment=bellicoso2016_step_down", "duration_s=3", "tag=${robot.name}"],
        ["seed=1", "++seed=2", "seed=3"],
        ["seed=1", "++seed=2"],
        ["scenario.friction=0.5", "scenario={friction: 0.3}"],
        ["launcher=slurm", "pool.workers=1", "hydra.job.name=x"],
        ["tag='a b'", "controller.tracking.contact.capture_margin_m=null"],
    ],
)
def test_documents_are_those_of_hydra(overrides: list[str]) -> None:
    composer = Composer()
    composer.compose(["seed=9", "tag=other", *[o for o in overrides if o.startswith("gait=")]])
    expected = compose_document(overrides)
    for _ in range(2):
        found = composer.compose(overrides)
        assert OmegaConf.to_yaml(found) == OmegaConf.to_yaml(expected)
        assert OmegaConf.to_container(found, resolve=True) == OmegaConf.to_container(expected, resolve=True)


@pytest.mark.parametrize("override", ["sed=1", "gait=trto", "gait.cycles.7.pattern=1", "seed=[1", "seed", "~sed", "=3"])
def test_mistakes_are_told_as_by_hydra(override: str) -> None:
    with pytest.raises(ConfigurationError) as expected:
        compose_document(["seed=1", override])
    with pytest.raises(ConfigurationError) as found:
        Composer().compose(["seed=1", override])
    assert str(found.value) == str(expected.value)


def test_files_that_repeat_are_composed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    composed: list[tuple[str, ...]] = []

    def compose(choices: tuple[str, ...]) -> DictConfig:
        composed.append(choices)
        return compose_document(choices)

    monkeypatch.setattr(composer_module, "compose_document", compose)
    composer = Composer()
    for gait in ("walk", "trot"):
        for seed in range(3):
            assert composer.compose([f"gait={gait}", f"seed={seed}"]).seed == seed
    assert composed == [("gait=walk",), ("gait=trot",)]
