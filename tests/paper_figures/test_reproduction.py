"""What can be asked of ``experiments/reproduce.py``, and how it answers mistakes."""

import pytest

from paper_figures.reproduction import PAPERS, ReproduceOptions, chosen_scripts, main, read_options
from quadlab.errors import ConfigurationError


def test_options_are_pairs_of_key_and_value() -> None:
    options = read_options(["paper=winkler2017", "artefact=figure2", "jobs=3"])
    assert options == ReproduceOptions(paper="winkler2017", artefact="figure2", jobs=3)


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["winkler2017"], r"'winkler2017': expected key=value; known: paper=..., artefact=..., jobs=..."),
        (["paper=winkler2071"], "paper"),
        (["papers=all"], "papers"),
        (["jobs=0"], "jobs"),
    ],
)
def test_mistake_is_one_line_and_code_2(arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 2
    message = capsys.readouterr().err
    assert message.startswith("quadlab: ")
    assert line in message
    assert message.count("\n") == 1


def test_help_names_every_option(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    printed = capsys.readouterr().out
    assert all(name in printed for name in (*ReproduceOptions.model_fields, *PAPERS, "comparison"))


def test_all_are_the_papers_without_the_comparison() -> None:
    assert {script.paper for script in chosen_scripts(ReproduceOptions())} == set(PAPERS)


def test_artefact_is_chosen_by_a_part_of_its_name() -> None:
    names = [script.name for script in chosen_scripts(ReproduceOptions(artefact="figure6"))]
    assert names == ["figure6_trot_plank"]
    with pytest.raises(ConfigurationError, match="artefact: unknown 'figure66'"):
        chosen_scripts(ReproduceOptions(artefact="figure66"))
