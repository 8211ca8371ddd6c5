"""Tables and figures of the papers are drawn from the results kept with the code; one machine gives the same bytes."""

from functools import cache
from io import StringIO
from pathlib import Path

import pandas as pd
import pytest

from paper_figures.gallery import FLOAT_FORMAT, ArtefactScript, artefact_scripts, draw_artefact
from paper_figures.readme_table import with_table
from paper_figures.report_page import origins, write_page
from paper_figures.reproduction import FOLDER
from paper_figures.summary import Judged, judge
from quadlab.analysis.study_results import StudyResults
from quadlab.studies.config import study_names

ROOT = FOLDER.parent
RESULTS = StudyResults(ROOT / "results")
SCRIPTS = artefact_scripts([])
NAMES = [f"{script.paper}.{script.name}" for script in SCRIPTS]
WANTED = {
    *("G-F1", "G-F2", "G-F3", "G-F4", "G-TAB1", "G-F5", "G-F6", "G-F7", "G-F8"),
    *("W-TAB1", "W-F2", "W-F3", "W-F5", "W-X1", "W-X2", "W-X3"),
    *("B-F4", "B-F56", "B-X1", "X-S1"),
}
ONE_OF_THE_LAST_DIGITS = 2e-5
CANCELLED = 1e-9  # rounding that differences of nearly equal numbers leave over
each_script = pytest.mark.parametrize("script", SCRIPTS, ids=NAMES)


@cache
def judged(script: ArtefactScript) -> Judged:
    return judge([script], RESULTS)[0]


def needs_results(script: ArtefactScript) -> None:
    if judged(script).problem:
        pytest.skip(judged(script).problem)


@each_script
def test_two_drawings_are_the_same_bytes(script: ArtefactScript, tmp_path: Path) -> None:
    needs_results(script)
    once, again = (draw_artefact(script, RESULTS, tmp_path / name) for name in ("once", "again"))
    for first, second in zip(once, again, strict=True):
        assert first.read_bytes() == second.read_bytes(), first.name


@each_script
def test_kept_numbers_are_those_of_the_kept_results(script: ArtefactScript) -> None:
    """Up to the last digit that is written: vector instructions of another processor may round otherwise."""
    needs_results(script)
    kept = pd.read_csv(FOLDER / script.paper / f"{script.name}.csv")
    drawn = pd.read_csv(StringIO(script.numbers(RESULTS).to_csv(index=False, float_format=FLOAT_FORMAT)))
    pd.testing.assert_frame_equal(drawn, kept, rtol=ONE_OF_THE_LAST_DIGITS, atol=CANCELLED)


@each_script
def test_claims_say_something(script: ArtefactScript) -> None:
    needs_results(script)
    for claim in judged(script).claims:
        assert claim.text
        assert claim.paper
        assert claim.ours
        assert "nan" not in claim.ours
        assert not claim.ours.startswith("0 of 0"), claim.text


@each_script
def test_studies_of_an_artefact_exist(script: ArtefactScript) -> None:
    assert set(script.artefact.studies) <= set(study_names())


@each_script
def test_caption_is_a_sentence(script: ArtefactScript) -> None:
    assert script.artefact.caption.endswith(".")
    assert len(script.artefact.caption) > 80


def test_every_table_and_figure_has_a_script() -> None:
    identifiers = [script.artefact.identifier for script in SCRIPTS]
    assert not WANTED - {identifier.split()[0] for identifier in identifiers}
    assert len(set(identifiers)) == len(identifiers)


def test_readme_shows_the_verdicts_of_the_kept_results() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert text == with_table(text, [judged(script) for script in SCRIPTS]), "python -m paper_figures renews the table"


def test_page_needs_no_network_and_holds_every_claim(tmp_path: Path) -> None:
    nothing = StudyResults(tmp_path)
    page = write_page(judge(SCRIPTS, nothing), nothing, FOLDER).read_text(encoding="utf-8")
    assert "src=" in page  # what needs no results is drawn
    assert "http" not in page
    assert all(script.artefact.title in page for script in SCRIPTS)


def test_origins_are_those_of_the_manifests() -> None:
    for entry in map(judged, SCRIPTS):
        for origin in origins(entry, RESULTS):
            assert origin.jobs > 0
            assert origin.packages
