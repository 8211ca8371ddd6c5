"""One self-contained page: every artefact beside its claims, with its command and where its numbers come from."""

import base64
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from paper_figures.gallery import ArtefactScript
from paper_figures.summary import Judged, judge
from quadlab.analysis.study_results import StudyResults
from quadlab.trials.files import write_text

TEMPLATE = "report_page.html.jinja"
PAPERS = {
    "gehring2017": "Gehring 2017",
    "winkler2017": "Winkler 2017",
    "bellicoso2016": "Bellicoso 2016",
    "comparison": "Comparison that no paper has",
}
SHOWN_PACKAGES = ("mujoco", "pin", "numpy", "numba", "casadi", "osqp", "proxsuite")


@dataclass(frozen=True)
class Origin:
    """Where the numbers of a study come from.

    Attributes:
        study: its name.
        jobs: how many.
        commits: that ran them, shortened.
        machine: processor.
        packages: versions of the ones that matter most.
    """

    study: str
    jobs: int
    commits: str
    machine: str
    packages: str


def write_page(scripts: Sequence[ArtefactScript], results: StudyResults, figures: Path) -> Path:
    """Write ``report.html`` beside the results and return its path; figures are read from ``figures``."""
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    judged = judge(scripts, results)
    papers = {
        title: [entry for entry in judged if entry.script.paper == paper]
        for paper, title in PAPERS.items()
        if any(entry.script.paper == paper for entry in judged)
    }
    page = environment.get_template(TEMPLATE).render(
        papers=papers,
        picture=lambda entry: picture(entry, figures),
        origins=lambda entry: origins(entry, results),
    )
    path = results.folder / "report.html"
    write_text(path, page)
    return path


def picture(entry: Judged, figures: Path) -> str | None:
    """Return the figure as a data address, or None if it was not drawn."""
    path = figures / entry.script.paper / f"{entry.script.name}.png"
    if not entry.claims or not path.is_file():
        return None
    return f"data:image/png;base64,{base64.b64encode(path.read_bytes()).decode()}"


def origins(entry: Judged, results: StudyResults) -> list[Origin]:
    """Return where the numbers of an artefact come from, one entry a study that has been run."""
    found = []
    for study in entry.script.artefact.studies:
        path = results.folder / study / "manifest.json"
        if path.is_file():
            found.append(_origin(study, json.loads(path.read_text(encoding="utf-8"))))
    return found


def _origin(study: str, manifest: dict[str, object]) -> Origin:
    commits, packages, cpu = manifest.get("commits"), manifest.get("packages"), manifest.get("cpu")
    commits = commits if isinstance(commits, dict) else {}
    packages = packages if isinstance(packages, dict) else {}
    cpu = cpu if isinstance(cpu, dict) else {}
    return Origin(
        study=study,
        jobs=int(str(manifest.get("jobs", 0))),
        commits=", ".join(str(commit)[:10] for commit in commits),
        machine=f"{cpu.get('model', 'unknown processor')}, {cpu.get('cores', '?')} cores",
        packages=", ".join(f"{name} {packages[name]}" for name in SHOWN_PACKAGES if name in packages),
    )
