"""A table as a figure shows every cell, whole, and no two of them on top of each other."""

from itertools import pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.lines import Line2D

from quadlab.plotting.style import COLUMN_WIDTH, paper_style
from quadlab.plotting.table_figure import TableText, table_figure

TABLE = TableText(
    header=(("", "paper", "", "here"), ("motion", "time [s]", "variables", "time [s]")),
    rows=(("walk, a long name", "0.25", "646", "0.0025"), ("trot", "0.02", "387", "0.0003")),
    rules=(0,),
    notes=("a note",),
)


@paper_style()
def test_cells_lie_inside_and_beside_each_other() -> None:
    wide = TableText((tuple(f"column {n}" for n in range(12)),), (tuple(str(10.0**n) for n in range(12)),))
    for table in (TABLE, wide):
        figure = table_figure(table, COLUMN_WIDTH)
        FigureCanvasAgg(figure)
        figure.set_dpi(400)  # pixels round the widths of small type
        boxes = {text.get_text(): text.get_window_extent() for text in figure.texts}
        assert set(boxes) == {cell for line in (*table.header, *table.rows) for cell in line} | set(table.notes)
        assert all(box.x0 > -1.0 and box.x1 <= figure.bbox.x1 + 1.0 for box in boxes.values())
        for line in table.rows:
            assert all(boxes[left].x1 < boxes[right].x0 for left, right in pairwise(line))


@paper_style()
def test_the_name_of_a_group_is_over_the_middle_of_a_rule_as_wide_as_its_columns() -> None:
    grouped = TableText((("", "group", "", "alone"), ("motion", "a", "b", "c")), (("walk", "1", "22", "3"),))
    figure = table_figure(grouped, COLUMN_WIDTH)
    FigureCanvasAgg(figure)
    place = {text.get_text(): text.get_position()[0] for text in figure.texts}
    spans = [tuple(np.asarray(line.get_xdata(), float).tolist()) for line in figure.findobj(Line2D)]
    (rule,) = set(spans) - {max(spans, key=lambda ends: ends[1] - ends[0])}
    assert place["group"] == pytest.approx(0.5 * sum(rule))
    assert place["motion"] < rule[0] < place["a"] < place["b"] == pytest.approx(rule[1])
    assert place["alone"] == place["c"]
