"""A table as a figure, in the look of printed papers: three rules and one below each group name, no vertical lines."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.textpath import TextPath

from quadlab.plotting.style import MEASURED, TEXT_WIDTH, paper_style

_FONT_SIZE = 7.0  # [pt]
_ROW = 0.155  # [in]
_GAP = 0.14  # [in] between two columns, at least
_MARGIN = 0.06  # [in]
_POINTS = 72.0  # [1/in]
_THICK, _THIN = 0.9, 0.4  # [pt]


@dataclass(frozen=True)
class TableText:
    """What a table says.

    Attributes:
        header: lines of names, the last one of the columns; those above name groups, which empty names continue.
        rows: lines of cells, each as long as the header.
        rules: numbers of the rows after which there is a thin rule.
        notes: lines below the table.
        left: how many columns, from the first, are aligned to the left; the others are to the right.
    """

    header: tuple[tuple[str, ...], ...]
    rows: tuple[tuple[str, ...], ...]
    rules: tuple[int, ...] = ()
    notes: tuple[str, ...] = ()
    left: int = 1


@paper_style()
def table_figure(table: TableText, width_in: float = TEXT_WIDTH) -> Figure:
    """Return the figure of ``table``; a table that needs more than ``width_in`` in [in] is set in smaller type."""
    lines = [*table.header, *table.rows]
    size = _FONT_SIZE * min(1.0, (width_in - 2.0 * _MARGIN) / sum(_column_widths(table, _FONT_SIZE)))
    widths = _column_widths(table, size)
    spare = (width_in - 2.0 * _MARGIN - sum(widths)) / max(1, len(widths) - 1)
    note_lines = len(table.notes)
    height = 2.0 * _MARGIN + _ROW * (len(lines) + 0.4 + note_lines)
    figure = Figure((width_in, height))
    edges = list(_edges(widths, spare))
    for number, line in enumerate(lines):
        y = height - _MARGIN - _ROW * (number + 0.5 + (0.2 if number >= len(table.header) else 0.0))
        draw_line = _draw_groups if number < len(table.header) - 1 else _draw_line
        draw_line(figure, line, edges, y, size, table.left)
    for number, note in enumerate(table.notes):
        y = _MARGIN + _ROW * (note_lines - number - 0.6)
        figure.text(_MARGIN / width_in, y / height, note, fontsize=min(size, 6.5), va="center")
    for y, weight in _rule_heights(table, height):
        _draw_rule(figure, (_MARGIN, width_in - _MARGIN), y, weight)
    return figure


def _column_widths(table: TableText, size: float) -> list[float]:
    """Return the width of the widest cell of each column with its gap in [in]; the first header lines may overhang."""
    lines = [table.header[-1], *table.rows]
    gap = _GAP * size / _FONT_SIZE
    return [max(_text_width(line[column], size) for line in lines) + gap for column in range(len(table.header[-1]))]


def _text_width(text: str, size: float) -> float:
    if not text.strip():
        return 0.0
    extents = TextPath((0.0, 0.0), text, prop=FontProperties(family="DejaVu Sans", size=size)).get_extents()
    return float(extents.x1) / _POINTS


def _edges(widths: Sequence[float], spare: float) -> Iterator[tuple[float, float]]:
    """Yield left and right end of each column in [in]; the gap is on its left."""
    at = _MARGIN
    for number, width in enumerate(widths):
        end = at + width + (spare if number else 0.0)
        yield at, end
        at = end


def _draw_line(
    figure: Figure, line: Sequence[str], edges: Sequence[tuple[float, float]], y: float, size: float, left: int
) -> None:
    width, height = figure.get_size_inches()
    for number, (text, (begin, end)) in enumerate(zip(line, edges, strict=True)):
        x, side = (begin + (_GAP if number else 0.0), "left") if number < left else (end, "right")
        figure.text(x / width, y / height, text, ha=side, va="center", fontsize=size)


def _draw_groups(
    figure: Figure, line: Sequence[str], edges: Sequence[tuple[float, float]], y: float, size: float, left: int
) -> None:
    """Draw the names of groups of columns, each over the middle of a thin rule as wide as its group."""
    width, height = figure.get_size_inches()
    starts = [number for number, text in enumerate(line) if text]
    for first, following in pairwise([*starts, len(line)]):
        if following == first + 1:
            alone = [text if number == first else "" for number, text in enumerate(line)]
            _draw_line(figure, alone, edges, y, size, left)
            continue
        begin, end = edges[first][0] + _GAP, edges[following - 1][1]
        figure.text(0.5 * (begin + end) / width, y / height, line[first], ha="center", va="center", fontsize=size)
        _draw_rule(figure, (begin, end), y - 0.5 * _ROW, _THIN)


def _draw_rule(figure: Figure, ends: tuple[float, float], y: float, weight: float) -> None:
    width, height = figure.get_size_inches()
    figure.add_artist(Line2D([end / width for end in ends], [y / height] * 2, color=MEASURED, lw=weight))


def _rule_heights(table: TableText, height: float) -> Iterator[tuple[float, float]]:
    """Yield height in [in] and weight in [pt] of every rule."""
    head = len(table.header)
    yield height - _MARGIN, _THICK
    yield height - _MARGIN - _ROW * (head + 0.1), _THIN
    yield height - _MARGIN - _ROW * (head + len(table.rows) + 0.3), _THICK
    for row in table.rules:
        yield height - _MARGIN - _ROW * (head + row + 1 + 0.2), _THIN
