"""What can be asked of ``experiments/reproduce.py``, and how it answers mistakes."""

import os
import time
from pathlib import Path

import pytest

from paper_figures.gallery import PAPERS as TITLES
from paper_figures.gallery import ArtefactScript, artefact_scripts, is_drawn
from paper_figures.reproduction import PAPERS, ReproduceOptions, chosen_scripts, main, read_options
from quadlab.analysis.study_results import StudyResults
from quadlab.errors import ConfigurationError

LATER = time.time() + 1000.0  # [s] no file of the checkout is as new


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


def test_folder_without_a_title_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(TITLES, "comparison")
    with pytest.raises(ConfigurationError, match="paper_figures/comparison: no title"):
        artefact_scripts([])


def test_every_folder_with_a_title_can_be_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(TITLES, "thesis", "Figures of a thesis")
    assert [read_options([f"paper={folder}"]).paper for folder in TITLES] == list(TITLES)


@pytest.fixture
def drawn(tmp_path: Path) -> tuple[ArtefactScript, StudyResults, Path]:
    """An artefact whose results are older than its script, and that than its figure."""
    script = artefact_scripts(["figure8_transition"])[0]
    results, folder = StudyResults(tmp_path / "results"), tmp_path / "figures"
    table = results.folder / script.artefact.studies[0] / "table.csv"
    outputs = [folder / script.paper / f"{script.name}{suffix}" for suffix in (".png", ".pdf", ".csv")]
    for age, path in [(30.0, table), (20.0, folder / script.paper / "script.py"), *((10.0, path) for path in outputs)]:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
        os.utime(path, (LATER - age, LATER - age))
    return script, results, folder


def test_figure_is_drawn_again_only_if_results_or_scripts_are_newer(
    drawn: tuple[ArtefactScript, StudyResults, Path],
) -> None:
    script, results, folder = drawn
    assert is_drawn(*drawn)
    table = results.folder / script.artefact.studies[0] / "table.csv"
    os.utime(table, (LATER, LATER))
    assert not is_drawn(*drawn)
    os.utime(table, (LATER - 30.0, LATER - 30.0))
    os.utime(folder / script.paper / "script.py", (LATER, LATER))
    assert not is_drawn(*drawn)


def test_figure_that_is_missing_is_drawn(drawn: tuple[ArtefactScript, StudyResults, Path]) -> None:
    script, _, folder = drawn
    (folder / script.paper / f"{script.name}.pdf").unlink()
    assert not is_drawn(*drawn)
