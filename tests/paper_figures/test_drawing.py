"""Artefacts that are drawn side by side are those that are drawn one after the other, and each may fail alone."""

import io
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from paper_figures import reproduction
from paper_figures.drawing import drawings
from paper_figures.gallery import artefact_scripts
from paper_figures.reproduction import draw_all
from quadlab.analysis.study_results import StudyResults
from quadlab.studies.progress import StudyProgress

(SCHEDULES,) = artefact_scripts(["figure3_contact_schedules"])
OF_NO_STUDY = [SCHEDULES, replace(SCHEDULES, name="schedules_again")]
OF_A_STUDY = artefact_scripts(["figure8_transition"])


def _broken(results: StudyResults) -> Figure:
    raise ZeroDivisionError("no such figure")


@pytest.fixture
def results(tmp_path: Path) -> StudyResults:
    """Results of no study."""
    return StudyResults(tmp_path / "results")


def test_two_processes_write_the_same_bytes_as_one(results: StudyResults, tmp_path: Path) -> None:
    alone, beside = tmp_path / "alone", tmp_path / "beside"
    for workers, folder in ((1, alone), (2, beside)):
        drawn = list(drawings(OF_NO_STUDY, results, folder, workers))
        assert {drawing.script.name for drawing in drawn} == {script.name for script in OF_NO_STUDY}
        assert not any(drawing.problem for drawing in drawn)
    names = sorted(path.relative_to(alone) for path in alone.rglob("*.*"))
    assert len(names) == 3 * len(OF_NO_STUDY)
    assert names == sorted(path.relative_to(beside) for path in beside.rglob("*.*"))
    for name in names:
        assert (alone / name).read_bytes() == (beside / name).read_bytes(), name


@pytest.mark.parametrize("workers", [1, 2])
def test_artefact_without_results_is_told_and_counted(
    workers: int, results: StudyResults, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reproduction, "FOLDER", tmp_path / "paper_figures")
    stream = io.StringIO()
    assert draw_all([*OF_A_STUDY, *OF_NO_STUDY], results, workers, StudyProgress(stream)) == 1
    lines = stream.getvalue().splitlines()
    missing, *others = [line for line in lines if line.startswith("figure8_transition")]
    assert "not there; python experiments/run_study.py gehring2017_transition makes it" in missing
    assert not others
    assert "paper_figures/gehring2017/figure3_contact_schedules.pdf" in lines
    assert len(lines) == 1 + 3 * len(OF_NO_STUDY)


def test_what_broke_a_drawing_is_told_and_the_others_are_drawn(results: StudyResults, tmp_path: Path) -> None:
    broken = replace(SCHEDULES, name="broken", draw=_broken)
    found = {drawing.script.name: drawing for drawing in drawings([broken, SCHEDULES], results, tmp_path, 2)}
    problem = found["broken"].problem
    assert problem.startswith("ZeroDivisionError: no such figure\n")
    assert "in _broken" in problem
    assert not found[SCHEDULES.name].problem
