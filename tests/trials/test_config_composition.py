"""Every YAML file describes a trial; every mistake is found and named."""

from pathlib import Path

import pytest

from quadlab.errors import ConfigurationError
from quadlab.paths import CONF_DIR
from quadlab.trials.compose import compose_document, compose_trial, split_document

OPTIONS = sorted(
    f"{path.parent.name}={path.stem}"
    for path in CONF_DIR.glob("*/*.yaml")
    if path.parent.name not in ("experiment", "launcher", "study")
)
EXPERIMENTS = sorted(path.stem for path in CONF_DIR.glob("experiment/*.yaml"))
LONG_ENOUGH = "duration_s=60"


def _problems(*overrides: str) -> list[str]:
    with pytest.raises(ConfigurationError) as refusal:
        compose_trial(overrides)
    return str(refusal.value).splitlines()


@pytest.mark.parametrize("option", OPTIONS)
def test_every_option_of_every_group_composes_and_carries_its_own_name(option: str) -> None:
    group, name = option.split("=")
    part = getattr(compose_trial([option, LONG_ENOUGH]), group)
    assert getattr(part, "name", name) == name


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_every_experiment_composes(experiment: str) -> None:
    compose_trial([f"experiment={experiment}"])


def test_defaults_compose() -> None:
    assert compose_trial().robot.name == "anymal_b"


def test_run_options_are_no_part_of_the_trial() -> None:
    trial, options = split_document(compose_document(["force=true", "results_dir=elsewhere"]))
    assert (options.force, options.results_dir) == (True, "elsewhere")
    assert trial == compose_trial()


@pytest.mark.parametrize(
    ("override", "line"),
    [
        ("robot=anymal_x", "robot: unknown 'anymal_x'; did you mean 'anymal_"),
        ("gate=trot", "gate: unknown key; did you mean 'gait'?"),
        ("gait.nmae=x", "gait.nmae: unknown key; did you mean 'name'?; known: cycles, "),
        ("+robot.nmae=x", "robot.nmae: unknown key; did you mean 'name'?; known: "),
        ("+controller.rate=4", "controller.rate: unknown key; did you mean 'rate_hz'?; known: "),
        ("planner.kind=vertex_zpm", "planner.kind: unknown 'vertex_zpm'; did you mean 'vertex_zmp'?; known: "),
        ("+estimator.noise=1", "estimator.noise: unknown key; known: kind"),
        ("~planner.kind", "planner.kind: missing"),
        ("~seed", "seed: missing"),
        ("duration_s=abc", "duration_s: input should be a valid number"),
        ("duration_s=0", "duration_s: input should be greater than 0 (got 0)"),
        ("duration_s=.nan", "duration_s: input should be "),
        ("seed=1.5", "seed: input should be a valid integer"),
        ("seed=-1", "seed: input should be greater than or equal to 0 (got -1)"),
        ("tag=../up", "tag: "),
        ("robot.joints=[a,b]", "robot.joints: "),
        ("command.kind=goal_pose", "command.kind: unknown 'goal_pose'; did you mean 'goal'?; known: "),
        ("duration_s=${nothing}", "Interpolation key 'nothing' not found"),
        ("duration_s", "duration_s: cannot be read as key=value"),
        ("gait.cycles.7.stride_duration_s=1", "Error merging override gait.cycles.7.stride_duration_s=1: list index"),
        ("gait.cycles.x.stride_duration_s=1", "Index 'x' (str) is not an int"),
        ("gait.cycles.0.stride_s=1", "gait.cycles[0].stride_s: unknown key; did you mean 'stride_duration_s'?"),
        (
            "controller.levels.3.tasks.0.frame=control",
            "controller.levels[3].tasks[0].frame: unknown key; known: derivative_per_s, proportional_per_s2, task; "
            "an option of a task that its file leaves out takes a + in front",
        ),
        (
            "+controller.levels.3.tasks.0.frame=x",
            "controller.levels[3].tasks[0].frame: input should be 'world' or 'con",
        ),
        ("+=gait", "an override has no key; expected key=value"),
        ("~controller.levels.4", "~ takes no entry out of a list; override the whole list"),
        (
            "+controller.levels.3.tasks.0.fram=control",
            "controller.levels[3].tasks[0].fram: unknown key; did you mean 'frame'?; known: derivative_per_s, frame, ",
        ),
        (
            "controller.levels.3.tasks.0.task=com_positon",
            "controller.levels[3].tasks[0].task: unknown 'com_positon'; did you mean 'com_position'?; known: base_",
        ),
        ("~controller.levels.3.tasks.0.task", "controller.levels[3].tasks[0].task: missing"),
        ("~gait.cycles.0.pattern.LH", "gait.cycles[0].pattern: needs one row for each of LF, RF, LH, RH; has LF, "),
        (f"~{'x' * 300}", "/"),
        ("study=comparison", "study: no part of a trial; it is run by python experiments/run_study.py"),
        ("robot.legs.LH=LF", "robot.legs: expected a name of its own for each leg; got LF, RF, LF, RH"),
        ("robot.urdf=anymal_c/anymal.urdf", "robot anymal_b: no URDF 'anymal_c/anymal.urdf'; of "),
        ("=3", "Config group override must be a string"),
        ("force=perhaps", "force: input should be a valid boolean"),
    ],
)
def test_mistake_is_one_line(override: str, line: str) -> None:
    problems = _problems(override)
    assert len(problems) == 1
    assert problems[0].startswith(line)


def test_all_mistakes_are_reported_at_once() -> None:
    problems = _problems("seed=-1", "duration_s=abc", "+gait.period=1", "scenario.friction=0")
    assert sorted(line.split(":")[0] for line in problems) == ["duration_s", "gait.period", "scenario.friction", "seed"]


PUSH = "{body: BODY, direction: [1, 0, 0], force_n: 50, start_s: START, duration_s: DURATION}"


def _push(body: str = "base", start_s: float = 1.0, duration_s: float = 0.15) -> str:
    push = PUSH.replace("BODY", body).replace("START", str(start_s)).replace("DURATION", str(duration_s))
    return f"scenario.pushes=[{push}]"


@pytest.mark.parametrize(
    ("overrides", "line"),
    [
        (["controller.rate_hz=333"], "controller.rate_hz: a period of 0.003003 s is not a whole multiple"),
        (["gait=walk", "duration_s=3"], "duration_s: 3 s is too short for gait 'walk'"),
        ([_push(body="bse")], "scenario.pushes[0].body: unknown link 'bse'; did you mean 'base'?"),
        ([_push(start_s=99.0)], "scenario.pushes[0].start_s: 99 s is not before the end of the trial at 10 s"),
        ([_push(duration_s=0.1503)], "scenario.pushes[0].duration_s: a period of 0.1503 s is not a whole multiple"),
    ],
)
def test_parts_that_do_not_fit_together(overrides: list[str], line: str) -> None:
    problems = _problems(*overrides)
    assert len(problems) == 1
    assert problems[0].startswith(line)


def test_a_push_on_the_base_is_accepted() -> None:
    assert len(compose_trial([_push()]).scenario.pushes) == 1


def test_broken_yaml_file_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "trial.yaml").write_text("duration_s: 1\nduration_s: 2\n")
    monkeypatch.setattr("quadlab.trials.compose.CONF_DIR", tmp_path)
    (problem,) = _problems()
    assert problem.endswith("trial.yaml, line 2: found duplicate key duration_s")
