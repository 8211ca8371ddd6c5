"""How figures look: the same for every reader, whatever their own matplotlib settings are."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from matplotlib import style
from matplotlib.colors import to_hex

from quadlab.trials.recording import primitives

COLUMN_WIDTH = 3.5
"""Width of a column of a two-column paper in [in]."""
TEXT_WIDTH = 7.16
"""Width of both columns in [in]."""

LEG_COLOURS = tuple(to_hex(colour[:3]) for colour in primitives.LEG_COLOURS)
"""One colour a leg, order ``LEGS``: those of the log's 3-D view, distinguishable for colour-blind readers."""

MEASURED = "#1a1a1a"
REFERENCE = "#56b4e9"
COP = "#b2182b"
PUSH = "#b8860b"
GROUND = "#bdb5a7"
NEUTRAL = "#7f7f7f"
"""Whatever belongs to no leg, e.g. phases in which all of them stand."""
SERIES = ("#1a1a1a", "#0072b2", "#d55e00", "#009e73")
"""Lines that belong together but to no leg, in this order."""

_SETTINGS: dict[str, Any] = {
    "font.family": "DejaVu Sans",  # comes with matplotlib: the same glyphs on every machine
    "font.size": 7.5,
    "axes.titlesize": 7.5,
    "axes.labelsize": 7.5,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "legend.borderaxespad": 0.2,
    "legend.borderpad": 0.1,
    "legend.columnspacing": 1.0,
    "legend.handlelength": 1.4,
    "legend.handletextpad": 0.4,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.5,
    "lines.linewidth": 0.9,
    "lines.solid_capstyle": "round",
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "hatch.linewidth": 0.5,
    "figure.constrained_layout.h_pad": 0.02,
    "figure.constrained_layout.w_pad": 0.02,
    "figure.constrained_layout.hspace": 0.01,
    "savefig.dpi": 220,
    "pdf.fonttype": 42,  # TrueType: publishers refuse Type 3 fonts
    "svg.hashsalt": "quadlab",
}


@contextmanager
def paper_style() -> Iterator[None]:
    """Draw in the style of quadlab inside the block (or the decorated function); settings outside do not count."""
    with style.context(_SETTINGS, after_reset=True):
        yield
