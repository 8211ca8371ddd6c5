"""All claims of all artefacts in one table: ``results/artefacts.csv`` and ``results/artefacts.md``."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from paper_figures.gallery import ArtefactScript
from quadlab.analysis.artefact import Claim, overall
from quadlab.analysis.study_results import StudyResults
from quadlab.errors import LogError
from quadlab.trials.files import write_text

MISSING = "no results yet"


@dataclass(frozen=True)
class Judged:
    """An artefact with its claims.

    Attributes:
        script: of the artefact.
        claims: measured.
        problem: why there are none; empty if its results are there.
    """

    script: ArtefactScript
    claims: tuple[Claim, ...]
    problem: str = ""

    @property
    def verdict(self) -> str:
        """On all claims together."""
        return MISSING if self.problem else overall(self.claims).value


def judge(scripts: Sequence[ArtefactScript], results: StudyResults) -> list[Judged]:
    """Return what became of every artefact."""
    return [_judged(script, results) for script in scripts]


def _judged(script: ArtefactScript, results: StudyResults) -> Judged:
    try:
        return Judged(script, tuple(script.claims(results)))
    except LogError as error:
        return Judged(script, (), str(error))


def write_summary(judged: Sequence[Judged], folder: Path) -> list[Path]:
    """Write the table of claims as CSV and Markdown into ``folder`` and return the paths."""
    table, text = folder / "artefacts.csv", folder / "artefacts.md"
    write_text(table, claim_table(judged).to_csv(index=False))
    write_text(text, artefact_lines(judged))
    return [table, text]


def claim_table(judged: Sequence[Judged]) -> pd.DataFrame:
    """Return one row a claim."""
    columns = ["artefact", "source", "claim", "paper", "ours", "verdict", "why"]
    rows = [
        (entry.script.artefact.identifier, entry.script.artefact.source, claim.text, claim.paper, claim.ours,
         claim.verdict.value, claim.why)
        for entry in judged
        for claim in entry.claims
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=columns)


def artefact_lines(judged: Sequence[Judged]) -> str:
    """Return a Markdown table with one line an artefact and one a claim."""
    lines = ["| artefact | claim | paper | here (simulated) | verdict |", "|---|---|---|---|---|"]
    for entry in judged:
        artefact = entry.script.artefact
        figure = f"paper_figures/{entry.script.paper}/{entry.script.name}.png"
        lines.append(f"| [{artefact.source}]({figure}) | **{artefact.title}** | | | **{entry.verdict}** |")
        for claim in entry.claims:
            why = f" {claim.why}" if claim.why else ""
            lines.append(f"| | {claim.text} | {claim.paper} | {claim.ours} | {claim.verdict.value}.{why} |")
    return "\n".join(lines) + "\n"
