"""A comparison of trials as text, LaTeX and figure."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from quadlab.analysis.collect import collect
from quadlab.analysis.comparison import grouped, paired
from quadlab.analysis.comparison_tables import metric_table, paired_table, success_table
from quadlab.analysis.text_table import TextTable
from quadlab.errors import LogError
from quadlab.plotting.comparison_figure import comparison_figure
from quadlab.plotting.figure_files import save_figure
from quadlab.trials.files import write_text

FOLDER = "compare"
_NOT_IN_NAMES = re.compile(r"[^-+.\w]")
_NOTE = (
    "95 % intervals: Wilson's for shares; over pairs of equal conditions Bonett and Price's for differences of shares, "
    "Student's for differences of means"
)


@dataclass(frozen=True)
class ComparisonFiles:
    """What a comparison left.

    Attributes:
        text: all tables in Markdown.
        paths: of the files.
    """

    text: str
    paths: tuple[Path, ...]


def compare_trials(folder: Path, factors: Sequence[str], metric: str, baseline: str | None = None) -> ComparisonFiles:
    """Compare the trials below ``folder`` and write ``<folder>/compare/<metric>_by_<factors>.*``: md, tex, png and pdf.

    Args:
        folder: of the trials.
        factors: one or two, see ``factors.levels_of``; levels of the first are compared in pairs.
        metric: an outcome that is a number.
        baseline: level of the first factor that the others are compared with, which the names of the files then end
            in; the first by default.

    Raises:
        LogError: if no trial can be read, or a factor, the metric or the baseline is none.
    """
    collection = collect(folder)
    table, notes = collection.comparable, list(collection.notes())
    if table.empty:
        raise LogError(f"{folder}: no trial in it has a configuration that can be read")
    groups = grouped(table, factors, metric)
    tables = [success_table(groups, factors), metric_table(groups, factors, metric)]
    comparisons = paired(table, factors[0], metric, baseline)
    tables.append(paired_table(comparisons, factors[0], metric))
    name, target = _file_name(factors, metric, comparisons[0].first if baseline else None), folder / FOLDER
    text = "\n".join([*(table.markdown() for table in tables), *(f"{note}.\n" for note in [*notes, _NOTE])])
    texts = [_write(target / f"{name}.md", text), _write(target / f"{name}.tex", _latex(tables, notes))]
    return ComparisonFiles(text, (*texts, *save_figure(comparison_figure(groups, factors, metric), target, name)))


def _file_name(factors: Sequence[str], metric: str, baseline: str | None) -> str:
    name = "_by_".join([metric, *factors])
    return name if baseline is None else f"{name}_from_{_NOT_IN_NAMES.sub('_', baseline)}"


def _latex(tables: Sequence[TextTable], notes: Sequence[str]) -> str:
    return "\n".join([*(table.latex() for table in tables), *(f"% {note}\n" for note in notes)])


def _write(path: Path, text: str) -> Path:
    write_text(path, text)
    return path
