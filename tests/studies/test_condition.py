"""A study is the product of its factors, block by block, and every file of conf/study is one that can be run."""

from pathlib import Path

import pytest
from pydantic import ValidationError

import quadlab.studies.worker  # noqa: F401 - knows the jobs of all studies
from quadlab.errors import ConfigurationError
from quadlab.studies import config as study_config
from quadlab.studies.condition import Condition, conditions
from quadlab.studies.config import SearchConfig, StudyConfig, load_study, study_names
from quadlab.studies.consistency import study_problems
from quadlab.studies.jobs import JOBS
from quadlab.trials.compose import compose_trial

STUDY = StudyConfig.model_validate(
    {
        "title": "Two blocks",
        "blocks": [
            {
                "overrides": ["duration_s=4"],
                "factors": {"seed": [0, 1], "variant": {"aligned": [], "not": ["controller.tracking.x=none"]}},
            },
            {"factors": {"gait": ["walk"]}, "search": {"key": "f", "lowest": 1, "step": 1, "highest": 3, "confirm": 0}},
        ],
        "report_by": ["variant"],
    }
)


def test_blocks_are_products_of_their_factors() -> None:
    found = conditions(STUDY)
    assert [condition.levels for condition in found] == [
        {"seed": 0, "variant": "aligned"},
        {"seed": 0, "variant": "not"},
        {"seed": 1, "variant": "aligned"},
        {"seed": 1, "variant": "not"},
        {"gait": "walk"},
    ]
    assert found[1].overrides == ("duration_s=4", "seed=0", "controller.tracking.x=none")
    assert found[-1].probe(2.0).overrides == ("gait=walk", "f=2")


def test_names_of_jobs_depend_on_their_overrides_alone() -> None:
    first, second = Condition({"a": 1}, ("seed=1",)), Condition({"b": 2}, ("seed=1",))
    assert first.identifier == second.identifier
    assert first.identifier != Condition({"a": 1}, ("seed=2",)).identifier


def test_search_may_go_down_and_be_named_for_people() -> None:
    search = SearchConfig(key="height_m", lowest=0.1, step=0.1, highest=0.3, confirm=0, factor=-1.0, name="depth_m")
    probe = Condition({}, (), search).probe(0.2)
    assert probe.overrides == ("height_m=-0.2",)
    assert probe.levels == {"depth_m": 0.2}


def test_unknown_study_is_one_line_that_names_the_known_ones() -> None:
    with pytest.raises(ConfigurationError, match=r"unknown study 'acceptence'; did you mean 'acceptance'\?"):
        load_study("acceptence")


@pytest.mark.parametrize("name", study_names())
def test_every_level_of_every_study_is_a_valid_trial(name: str) -> None:
    study = load_study(name)
    assert study.job in JOBS
    if study.job not in ("trial", "plan"):
        return
    for condition in _covering(conditions(study)):
        compose_trial(condition.probe(condition.search.highest).overrides if condition.search else condition.overrides)


@pytest.mark.parametrize("name", study_names())
def test_what_is_kept_and_reported_exists(name: str) -> None:
    study = load_study(name)
    assert not list(study_problems(study, conditions(study)))


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        (
            {"report_by": ["sed"]},
            "report_by: unknown factor 'sed'; did you mean 'seed'?; known: f, gait, seed, variant",
        ),
        ({"report_by": ["seed", "robot", "f"]}, None),
        ({"plans": {"it": {"seed": 0}}}, "plan 'it': 2 jobs have seed: 0; expected one"),
        ({"plans": {"it": {"seed": 2}}}, "plan 'it': no jobs have seed: 2; expected one"),
        ({"plans": {"it": {"seed": 0, "variant": "not"}}}, None),
        ({"plans": {"it": {"variannt": "not"}}}, "plan 'it': unknown factor 'variannt'; did you mean 'variant'?"),
        (
            {"traces": [{"name": "it", "where": {"seed": 7, "gait": "walk"}, "columns": [], "rate_hz": 1}]},
            "trace 'it': no jobs have seed: 7, gait: walk; expected one",
        ),
        ({"traces": [{"name": "it", "where": {"gait": "walk", "f": 2}, "columns": [], "rate_hz": 1}]}, None),
    ],
)
def test_names_and_picks_that_do_not_fit_the_factors_are_found(changes: dict[str, object], line: str | None) -> None:
    study = StudyConfig.model_validate({**STUDY.model_dump(), **changes})
    problems = list(study_problems(study, conditions(study)))
    assert len(problems) == (line is not None)
    assert line is None or problems[0].startswith(line)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("title: [a\nblocks: 1\n", "study/x.yaml, line 2: not YAML (expected ',' or ']', but got ':')"),
        ("title: \x01\n", "study/x.yaml: not YAML (unacceptable character"),
        ("", "study/x.yaml: empty; expected keys such as title and blocks"),
        ("- a\n", "study/x.yaml: a list; expected keys such as title and blocks"),
    ],
)
def test_file_that_is_no_study_is_one_line(
    text: str, line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "study").mkdir()
    (tmp_path / "study" / "x.yaml").write_text(text)
    monkeypatch.setattr(study_config, "CONF_DIR", tmp_path)
    with pytest.raises(ConfigurationError) as refusal:
        load_study("x")
    assert str(refusal.value).startswith(line)
    assert len(str(refusal.value).splitlines()) == 1


def _covering(found: list[Condition]) -> list[Condition]:
    """Return so many conditions that every level of every factor is among them."""
    seen: set[tuple[str, object]] = set()
    chosen = []
    for condition in found:
        levels = set(condition.levels.items())
        if not levels <= seen:
            seen |= levels
            chosen.append(condition)
    return chosen


def test_search_without_a_value_is_refused() -> None:
    with pytest.raises(ValidationError, match="highest: 2 is below lowest, 3"):
        SearchConfig(key="height_m", lowest=3.0, step=0.5, highest=2.0, confirm=0)
