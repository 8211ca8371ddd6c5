"""A comparison of trials as text, LaTeX and figure."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from quadlab.analysis.collect import collect_trials
from quadlab.analysis.comparison import grouped, paired
from quadlab.analysis.comparison_tables import metric_table, paired_table, success_table
from quadlab.analysis.text_table import TextTable
from quadlab.plotting.comparison_figure import comparison_figure
from quadlab.plotting.figure_files import save_figure
from quadlab.trials.files import write_text

FOLDER = "compare"
_NOTE = (
    "95 % intervals: Wilson's for shares; over pairs of equal conditions Bonett and Price's for differences of shares, "
    "Student's for differences of means."
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
    """Compare the trials below ``folder`` and write ``<folder>/compare/<factors>.*``: md, tex, png and pdf.

    Args:
        folder: of the trials.
        factors: one or two columns; levels of the first are compared in pairs.
        metric: a numerical column of the result.
        baseline: level of the first factor that the others are compared with; the first by default.

    Raises:
        LogError: if a trial cannot be read or a column does not exist.
    """
    table = collect_trials(folder)
    groups = grouped(table, factors, metric)
    tables = [success_table(groups, factors), metric_table(groups, factors, metric)]
    comparisons = paired(table, factors[0], metric, baseline)
    if comparisons:
        tables.append(paired_table(comparisons, factors[0], metric))
    name, target = "_by_".join([metric, *factors]), folder / FOLDER
    text = "\n".join([*(table.markdown() for table in tables), _NOTE + "\n"])
    texts = [_write(target / f"{name}.md", text), _write(target / f"{name}.tex", _latex(tables))]
    return ComparisonFiles(text, (*texts, *save_figure(comparison_figure(groups, factors, metric), target, name)))


def _latex(tables: Sequence[TextTable]) -> str:
    return "\n".join(table.latex() for table in tables)


def _write(path: Path, text: str) -> Path:
    write_text(path, text)
    return path
