"""What README and CONTRIBUTING name is there, and the commands that they show are accepted."""

import re
import shlex
import subprocess
from pathlib import Path

import pytest
import yaml

from quadlab.paths import checkout_dir
from quadlab.studies.condition import conditions
from quadlab.studies.config import StudyConfig, load_study
from quadlab.trials.compose import compose_trial

ROOT = checkout_dir() or Path()
DOCUMENTS = ("README.md", "CONTRIBUTING.md", "results/README.md")
MADE_BY_THE_READER = {"conf/planner/yours.yaml"}
FOLDERS = ("experiments", "conf", "quadlab", "tests", "paper_figures", ".ci")
PATH = re.compile(rf"(?<![\w./<])((?:{'|'.join(map(re.escape, FOLDERS))})/[\w./-]*\w/?)(?![\w*<{{])")
LINK = re.compile(r"\]\(([^)#:]+)\)")

pytestmark = pytest.mark.skipif(checkout_dir() is None, reason="needs a source tree")
each_document = pytest.mark.parametrize("name", DOCUMENTS)


def _text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def _commands(name: str) -> list[str]:
    """Lines of code blocks and code in the text."""
    blocks = re.findall(r"```\w*\n(.*?)```", _text(name), re.DOTALL)
    lines = [line.split("  #")[0].strip() for block in blocks for line in block.splitlines()]
    return lines + re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", _text(name), flags=re.DOTALL))


def _tracked() -> set[str]:
    try:
        listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    except (FileNotFoundError, subprocess.CalledProcessError):
        pytest.skip("needs a git repository")
    return set(listed.splitlines())


@each_document
def test_files_and_folders_that_are_named_exist(name: str) -> None:
    named = set(PATH.findall(_text(name))) - MADE_BY_THE_READER
    assert not sorted(path for path in named if not (ROOT / path).exists())


@each_document
def test_links_lead_to_files_of_the_repository(name: str) -> None:
    tracked = _tracked()
    links = {(ROOT / name).parent.joinpath(link).resolve().relative_to(ROOT) for link in LINK.findall(_text(name))}
    assert not sorted(str(link) for link in links if str(link) not in tracked)


@each_document
def test_make_targets_that_are_named_exist(name: str) -> None:
    targets = set(re.findall(r"^([\w-]+):", _text("Makefile"), re.MULTILINE))
    named = {match[1] for command in _commands(name) if (match := re.match(r"make ([a-z-]+)", command))}
    assert named <= targets


@each_document
def test_studies_that_are_named_exist(name: str) -> None:
    for study in re.findall(r"experiments/run_study\.py ([a-z]\w*)", _text(name)):
        assert load_study(study).blocks


def _trial_commands() -> list[str]:
    """Single trials and plans; sweeps name several values for a key."""
    return [
        command
        for command in _commands("README.md")
        if re.match(r"quadlab (run|plan) \w", command) and " -m" not in command and "..." not in command
    ]


def _overrides_to_change_something() -> list[str]:
    section = _text("README.md").partition("## Change something")[2].partition("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("| ")]
    return [code for row in rows for code in re.findall(r"`([^`]+)`", row) if re.match(r"[a-z][\w.]*=", code)]


@pytest.mark.parametrize("command", [*_trial_commands(), *_overrides_to_change_something()])
def test_overrides_that_are_shown_are_accepted(command: str) -> None:
    compose_trial([word for word in shlex.split(command) if "=" in word])


def test_study_that_is_shown_is_one() -> None:
    blocks = re.findall(r"```yaml\n(title:.*?)```", _text("README.md"), re.DOTALL)
    study = StudyConfig.model_validate(yaml.safe_load(blocks[0]))
    for condition in conditions(study):
        compose_trial(condition.overrides)


def test_there_are_commands_to_check() -> None:
    assert len(_trial_commands()) >= 2
    assert len(_overrides_to_change_something()) >= 15
