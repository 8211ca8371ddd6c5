"""One self-contained page: every artefact beside its claims, with its command and where its numbers come from."""

import base64
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from paper_figures.gallery import PAPERS
from paper_figures.study_origin import Origin, study_origins
from paper_figures.summary import Judged
from quadlab.analysis.artefact import Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.trials.files import write_text

TEMPLATE = "report_page.html.jinja"


def write_page(judged: Sequence[Judged], results: StudyResults, figures: Path) -> Path:
    """Write ``report.html`` beside the results and return its path; figures are read from ``figures``."""
    path = results.folder / "report.html"
    write_text(path, page(judged, results, figures))
    return path


def page(judged: Sequence[Judged], results: StudyResults, figures: Path) -> str:
    """Return the page: a table of verdicts, then the artefacts paper by paper; nothing is fetched to show it."""
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    return environment.get_template(TEMPLATE).render(
        papers=by_paper(judged),
        tally=tally,
        picture=lambda entry: picture(entry, figures),
        origins=lambda entry: origins(entry, results),
    )


def by_paper(judged: Sequence[Judged]) -> dict[str, list[Judged]]:
    """Return the artefacts of each paper by its title; papers without any are left out."""
    groups = {title: [entry for entry in judged if entry.script.paper == paper] for paper, title in PAPERS.items()}
    return {title: entries for title, entries in groups.items() if entries}


def tally(entry: Judged) -> str:
    """Return how many claims have which verdict, e.g. "3 reproduced, 1 partly"."""
    counts = Counter(claim.verdict for claim in entry.claims)
    return ", ".join(f"{counts[verdict]} {verdict.value}" for verdict in Verdict if counts[verdict])


def picture(entry: Judged, figures: Path) -> str | None:
    """Return the figure as a data address, or None if it was not drawn."""
    path = figures / entry.script.paper / f"{entry.script.name}.png"
    if entry.problem or not path.is_file():
        return None
    return f"data:image/png;base64,{base64.b64encode(path.read_bytes()).decode()}"


def origins(entry: Judged, results: StudyResults) -> list[Origin]:
    """Return where the numbers of an artefact come from, one entry a study that has been run."""
    return study_origins(entry.script.artefact.studies, results)
