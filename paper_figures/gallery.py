"""The scripts of all artefacts, found below this package.

Each is a module ``paper_figures/<paper>/<artefact>.py`` with

- ``ARTEFACT``: what it is and from which studies it is drawn,
- ``draw(results)``: the figure,
- ``numbers(results)``: what is drawn, as a table,
- ``claims(results)``: what the paper says, beside what was measured; empty for a figure that claims nothing.
"""

import importlib
import pkgutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

import paper_figures
from quadlab import plotting
from quadlab.analysis.artefact import Artefact, Claim
from quadlab.analysis.study_results import StudyResults
from quadlab.errors import ConfigurationError
from quadlab.paths import CONF_DIR
from quadlab.plotting.figure_files import save_figure
from quadlab.trials.files import write_text

FLOAT_FORMAT = "%.6g"
KEPT = ("traces", "plans")
"""Folders of a study that figures are drawn from, beside its tables."""
PAPERS = {
    "gehring2017": "Gehring 2017",
    "winkler2017": "Winkler 2017",
    "bellicoso2016": "Bellicoso 2016",
    "comparison": "A comparison that no paper has",
}
"""Title of each folder, in the order of all overviews; a new folder gets one here."""


@dataclass(frozen=True)
class ArtefactScript:
    """One script.

    Attributes:
        paper: folder, e.g. "gehring2017".
        name: module, e.g. "figure6_trot_plank".
        artefact: what it is.
        draw, numbers, claims: its functions of the results.
    """

    paper: str
    name: str
    artefact: Artefact
    draw: Callable[[StudyResults], Figure]
    numbers: Callable[[StudyResults], pd.DataFrame]
    claims: Callable[[StudyResults], Sequence[Claim]]

    @property
    def command(self) -> str:
        """What makes it from nothing."""
        return f"python experiments/reproduce.py paper={self.paper} artefact={self.name}"


def artefact_scripts(names: Sequence[str]) -> list[ArtefactScript]:
    """Return all scripts whose ``<paper>.<module>`` contains one of ``names``, or all if none are given.

    Raises:
        ConfigurationError: if no script has such a name, or its folder no title.
    """
    found = []
    for module in pkgutil.walk_packages(paper_figures.__path__, "paper_figures."):
        _, paper, *rest = module.name.split(".")
        if rest and (not names or any(name in f"{paper}.{rest[0]}" for name in names)):
            script = importlib.import_module(module.name)
            found.append(ArtefactScript(paper, rest[0], script.ARTEFACT, script.draw, script.numbers, script.claims))
    if not found:
        raise ConfigurationError(f"artefact: unknown '{' '.join(names)}'; expected a part of <paper>.<script>")
    untitled = sorted({script.paper for script in found} - PAPERS.keys())
    if untitled:
        raise ConfigurationError(f"paper_figures/{untitled[0]}: no title; expected one in PAPERS of gallery.py")
    return sorted(found, key=lambda script: list(PAPERS).index(script.paper))


def is_drawn(script: ArtefactScript, results: StudyResults, folder: Path) -> bool:
    """Return whether all that ``draw_artefact`` writes is newer than its results, the scripts and the configuration."""
    drawn = [folder / script.paper / f"{script.name}{suffix}" for suffix in (".png", ".pdf", ".csv")]
    studies = [results.folder / study for study in script.artefact.studies]
    if not all(path.is_file() for path in drawn) or not all(study.is_dir() for study in studies):
        return False
    sources = [path for study in studies for path in study.glob("*.*")]
    sources += [path for study in studies for part in KEPT for path in (study / part).glob("*")]
    sources += [*folder.rglob("*.py"), *CONF_DIR.rglob("*.yaml"), *Path(plotting.__file__).parent.rglob("*.py")]
    return min(path.stat().st_mtime for path in drawn) > max(path.stat().st_mtime for path in sources)


def draw_artefact(script: ArtefactScript, results: StudyResults, folder: Path) -> list[Path]:
    """Write the figure as PDF and PNG and its numbers as CSV into ``<folder>/<paper>/`` and return the paths.

    Raises:
        LogError: if a study that it needs has not been run.
    """
    paths = save_figure(script.draw(results), folder / script.paper, script.name)
    table = folder / script.paper / f"{script.name}.csv"
    write_text(table, script.numbers(results).to_csv(index=False, float_format=FLOAT_FORMAT))
    return [*paths, table]
