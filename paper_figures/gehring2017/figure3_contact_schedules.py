"""Gehring 2017, Fig. 3: which leg stands at which sample of the lateral walk and of the trot.

Reads ``conf/gait/walk.yaml`` and ``conf/gait/trot.yaml``.
"""

import numpy as np
import pandas as pd
import yaml
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator

from quadlab.analysis.artefact import Artefact, Claim, Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.gaits.gait import CycleConfig, GaitConfig
from quadlab.paths import CONF_DIR
from quadlab.plotting.style import COLUMN_WIDTH, paper_style
from quadlab.robots.legs import LEGS

ARTEFACT = Artefact("G-F3", "Gehring 2017, Fig. 3", "Contact schedules of the experiments", ())
PANELS = (("a", "lateral walk", "walk"), ("b", "trot", "trot"))


@paper_style()
def draw(_: StudyResults) -> Figure:
    """Return the figure: one panel a gait, dark where a leg stands."""
    figure = Figure(figsize=(COLUMN_WIDTH, 2.2), layout="constrained")
    for axes, (letter, title, gait) in zip(figure.subplots(2, 1), PANELS, strict=True):
        cycle = first_cycle(gait)
        draw_cycle(axes, cycle)
        axes.set_title(f"({letter}) {title}, {cycle.stride_duration_s:g} s a stride", loc="left")
    return figure


def numbers(_: StudyResults) -> pd.DataFrame:
    """Return one row a gait, leg and sample: 1 where the leg stands."""
    return pd.DataFrame(
        [
            {"gait": gait, "leg": leg, "sample": sample + 1, "stands": int(stands)}
            for _, _, gait in PANELS
            for leg, column in zip(LEGS, first_cycle(gait).contacts().T, strict=True)
            for sample, stands in enumerate(column)
        ]
    )


def claims(_: StudyResults) -> list[Claim]:
    """Return what the paper's text says of the schedules; they are inputs."""
    samples = len(first_cycle("walk").contacts())
    return [Claim("samples of a stride", "16", str(samples), Verdict.REPRODUCED, "The schedules are inputs.")]


def first_cycle(gait: str) -> CycleConfig:
    """Return the first cycle of ``conf/gait/<gait>.yaml``."""
    text = (CONF_DIR / "gait" / f"{gait}.yaml").read_text(encoding="utf-8")
    return GaitConfig.model_validate(yaml.safe_load(text)).cycles[0]


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
