"""Gehring 2017, Fig. 3: which leg stands at which sample of the lateral walk and of the trot.

Reads ``conf/gait/walk.yaml`` and ``conf/gait/trot.yaml``.
"""

import numpy as np
import yaml
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator

from quadlab.gaits.gait import CycleConfig, GaitConfig
from quadlab.paths import CONF_DIR
from quadlab.plotting.style import COLUMN_WIDTH, paper_style
from quadlab.robots.legs import LEGS

PANELS = (("a", "lateral walk", "walk"), ("b", "trot", "trot"))


@paper_style()
def draw() -> Figure:
    """Return the figure: one panel a gait, dark where a leg stands."""
    figure = Figure(figsize=(COLUMN_WIDTH, 2.2), layout="constrained")
    for axes, (letter, title, gait) in zip(figure.subplots(2, 1), PANELS, strict=True):
        text = (CONF_DIR / "gait" / f"{gait}.yaml").read_text(encoding="utf-8")
        cycle = GaitConfig.model_validate(yaml.safe_load(text)).cycles[0]
        draw_cycle(axes, cycle)
        axes.set_title(f"({letter}) {title}, {cycle.stride_duration_s:g} s a stride", loc="left")
    return figure


def draw_cycle(axes: Axes, cycle: CycleConfig) -> None:
    """Draw one stride, a row a leg and a column a sample."""
    contacts = cycle.contacts()
    samples = len(contacts)
    axes.imshow(~contacts.T, cmap="gray", vmin=-0.25, vmax=1.0, aspect="auto", interpolation="none")
    axes.set_yticks(range(len(LEGS)), LEGS)
    axes.set_xticks(np.arange(0, samples, 3), [str(sample + 1) for sample in range(0, samples, 3)])
    axes.xaxis.set_minor_locator(FixedLocator(list(np.arange(-0.5, samples))))
    axes.yaxis.set_minor_locator(FixedLocator(list(np.arange(-0.5, len(LEGS)))))
    axes.grid(visible=False, which="major")
    axes.grid(which="minor", color="white", linewidth=0.8)
    axes.tick_params(which="minor", length=0)
    axes.set_xlabel("sample")
