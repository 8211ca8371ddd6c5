"""The page of all artefacts: complete, the same bytes every time, and readable without a network."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure

from paper_figures.gallery import ArtefactScript, artefact_scripts, draw_artefact
from paper_figures.readme_table import BEGIN, END, with_table
from paper_figures.report_page import page, tally
from paper_figures.study_origin import code_state, study_origins
from paper_figures.summary import MISSING, Judged, judge
from quadlab.analysis.artefact import Artefact, Claim, Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.errors import ConfigurationError

STUDY = "acceptance"
CLAIMS = [
    Claim("trots <over> it", "recovers", "9 of 10 (60 to 98 %)", Verdict.PARTLY, "A foot slips off the edge."),
    Claim("walks over it", "-", "10 of 10 (72 to 100 %)", Verdict.REPRODUCED),
    Claim("walks & trots", "-", "10 of 10 (72 to 100 %)", Verdict.REPRODUCED),
]
MANIFEST = {
    "jobs": 3,
    "commits": {"1234567890ab": 2, "abcdef012345": 1},
    "git": {"commit": "fedcba987654"},
    "configuration_sha256": "c" * 64,
    "lock_sha256": None,
    "cpu": {"model": None, "cores": 2, "flags": ["avx2"]},
    "environment": {"OMP_NUM_THREADS": "1"},
    "packages": {"mujoco": "3.3.0"},
}


def _script(studies: tuple[str, ...] = ()) -> ArtefactScript:
    artefact = Artefact("G-F6", "Gehring 2017, Fig. 6", "A trot over a plank", studies, "Heights <of> the feet.")

    def claims(results: StudyResults) -> list[Claim]:
        for study in studies:
            results.table(study)
        return CLAIMS

    return ArtefactScript("gehring2017", "figure6", artefact, lambda _: Figure(), lambda _: pd.DataFrame(), claims)


@pytest.fixture
def results(tmp_path: Path) -> StudyResults:
    return StudyResults(tmp_path / "results")


def _page(script: ArtefactScript, results: StudyResults) -> str:
    return page(judge([script], results), results, results.folder.parent)


def test_claims_stand_on_the_page_and_the_figure_in_it(results: StudyResults) -> None:
    draw_artefact(_script(), results, results.folder.parent)
    text = _page(_script(), results)
    assert 'src="data:image/png;base64,' in text
    assert "trots &lt;over&gt; it" in text
    assert "walks &amp; trots" in text
    assert "G-F6: Heights &lt;of&gt; the feet." in text
    assert all(claim.ours in text and claim.why in text for claim in CLAIMS)
    assert "python experiments/reproduce.py paper=gehring2017 artefact=figure6" in text


def test_page_is_the_same_every_time(results: StudyResults) -> None:
    draw_artefact(_script(), results, results.folder.parent)
    assert _page(_script(), results) == _page(_script(), results)


def test_figure_that_claims_nothing_is_new_and_not_missing(results: StudyResults) -> None:
    script = replace(_script(), claims=lambda _: [])
    draw_artefact(script, results, results.folder.parent)
    (entry,) = judge([script], results)
    assert entry.verdict == Verdict.NEW
    assert "<img" in _page(script, results)
    assert "paper_figures/gehring2017/figure6.png" in with_table(f"{BEGIN}{END}", [entry])


def test_every_line_of_the_summary_leads_to_its_section(results: StudyResults) -> None:
    text = _page(_script(), results)
    targets = re.findall(r'href="#([^"]+)"', text)
    assert targets
    assert set(targets) == set(re.findall(r'<section id="([^"]+)"', text))


def test_missing_results_are_said_with_the_command_and_without_a_path_of_this_machine(results: StudyResults) -> None:
    text = _page(_script((STUDY,)), results)
    assert MISSING in text
    assert f"python experiments/run_study.py {STUDY} makes it" in text
    assert str(results.folder.parent) not in text
    assert "<img" not in text


def test_origin_of_a_study_is_told_in_full(results: StudyResults) -> None:
    (results.folder / STUDY).mkdir(parents=True)
    (results.folder / STUDY / "manifest.json").write_text(json.dumps(MANIFEST))
    (origin,) = study_origins([STUDY, "never_run"], results)
    assert origin.jobs == 3
    assert origin.code == "commits 1234567890 (2 jobs), abcdef0123 (1 jobs)"
    assert origin.machine == "unknown processor, 2 cores, avx2"
    assert (origin.environment, origin.lock, origin.packages) == ("OMP_NUM_THREADS=1", "none", "mujoco 3.3.0")


def test_code_without_trials_is_that_of_the_table() -> None:
    assert code_state({"commits": {}, "git": {"commit": "fedcba98765432"}}) == "commit fedcba9876"
    assert code_state({"commits": {}, "git": None}) == "commit unknown"


def test_changed_files_are_said() -> None:
    manifest = {"commits": {"1234567890ab": 2}, "git": {"commit": "fedcba98765432", "dirty": True}}
    assert code_state(manifest) == "commit 1234567890, with local changes"


def test_tally_counts_verdicts_best_first(results: StudyResults) -> None:
    assert tally(Judged(_script(), tuple(CLAIMS))) == "2 reproduced, 1 partly"


def test_table_replaces_what_is_between_the_marks_alone(results: StudyResults) -> None:
    judged = judge([_script()], results)
    text = with_table(f"before\n{BEGIN}\nold\n{END}\nafter\n", judged)
    assert text.startswith("before\n")
    assert text.endswith("after\n")
    assert "old" not in text
    assert text.count("| partly |") == 1
    assert with_table(text, judged) == text
    with pytest.raises(ConfigurationError, match="expected the marks"):
        with_table("no marks", judged)


def test_unknown_name_of_an_artefact_is_one_line() -> None:
    with pytest.raises(ConfigurationError, match="artefact: unknown 'figure99'"):
        artefact_scripts(["figure99"])
