"""Gehring 2017, Fig. 3: which leg stands at which sample of walk, trot and the transition.

Reads ``conf/gait/``.
"""

import numpy as np
import pandas as pd
import yaml
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator

from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.gaits.gait import CycleConfig, GaitConfig
from quadlab.gaits.schedule import BoolArray
from quadlab.paths import CONF_DIR
from quadlab.plotting.style import COLUMN_WIDTH, paper_style
from quadlab.robots.legs import LEGS

CAPTION = "One row a leg, one column a sample; dark: the leg stands. Read from the configuration, nothing is simulated."
ARTEFACT = Artefact("G-F3", "Gehring 2017, Fig. 3", "Contact schedules of the experiments", (), CAPTION)
PAPER_SAMPLES = 16
PANELS = (("a", "lateral walk", "walk"), ("b", "trot", "trot"), ("c", "walk to trot", "walk_to_trot_cycles"))


@paper_style()
def draw(_: StudyResults) -> Figure:
    """Return the figure: one panel a gait, dark where a leg stands."""
    figure = Figure(figsize=(COLUMN_WIDTH, 3.2), layout="constrained")
    for axes, (letter, title, gait) in zip(figure.subplots(len(PANELS), 1), PANELS, strict=True):
        strides = cycles(gait)
        draw_contacts(axes, contacts(strides))
        durations = " and ".join(f"{cycle.stride_duration_s:g} s" for cycle in strides)
        axes.set_title(f"({letter}) {title}, {durations} a stride", loc="left")
    return figure


def numbers(_: StudyResults) -> pd.DataFrame:
    """Return one row a gait, leg and sample: 1 where the leg stands."""
    return pd.DataFrame(
        [
            {"gait": gait, "leg": leg, "sample": sample + 1, "stands": int(stands)}
            for _, _, gait in PANELS
            for leg, column in zip(LEGS, contacts(cycles(gait)).T, strict=True)
            for sample, stands in enumerate(column)
        ]
    )


def claims(_: StudyResults) -> list[Claim]:
    """Return how many samples the walk needs; the schedules themselves are inputs."""
    fewest = fewest_samples(contacts(cycles("walk")))
    text = "fewest samples of a stride that realise the pattern of the walk"
    return [
        Claim(
            text,
            str(PAPER_SAMPLES),
            str(fewest),
            verdict(holds=fewest == PAPER_SAMPLES),
            "The pattern itself is an input.",
        )
    ]


def fewest_samples(stands: BoolArray) -> int:
    """Return in how few samples of equal length every lift-off and touch-down falls between two of them.

    Args:
        stands: which legs stand at the samples of a stride, (samples, 4).
    """
    switches = np.flatnonzero(np.any(stands != np.roll(stands, 1, axis=0), axis=1))
    return len(stands) // int(np.gcd.reduce([*switches.tolist(), len(stands)]))


def cycles(gait: str) -> list[CycleConfig]:
    """Return the cycles of ``conf/gait/<gait>.yaml``."""
    text = (CONF_DIR / "gait" / f"{gait}.yaml").read_text(encoding="utf-8")
    return list(GaitConfig.model_validate(yaml.safe_load(text)).cycles)


def contacts(strides: list[CycleConfig]) -> BoolArray:
    """Return which legs stand at the samples of all cycles, one after the other, (samples, 4)."""
    return np.vstack([cycle.contacts() for cycle in strides])


def draw_contacts(axes: Axes, stands: BoolArray) -> None:
    """Draw a row a leg and a column a sample."""
    samples = len(stands)
    axes.imshow(~stands.T, cmap="gray", vmin=-0.25, vmax=1.0, aspect="auto", interpolation="none")
    axes.set_yticks(range(len(LEGS)), LEGS)
    axes.set_xticks(np.arange(0, samples, 3), [str(sample + 1) for sample in range(0, samples, 3)])
    axes.xaxis.set_minor_locator(FixedLocator(list(np.arange(-0.5, samples))))
    axes.yaxis.set_minor_locator(FixedLocator(list(np.arange(-0.5, len(LEGS)))))
    axes.grid(visible=False, which="major")
    axes.grid(which="minor", color="white", linewidth=0.8)
    axes.tick_params(which="minor", length=0)
    axes.set_xlabel("sample")
