"""Figures as files: the same figure gives the same bytes."""

from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from quadlab.plotting.style import paper_style
from quadlab.trials.files import write_bytes

PAPER_FORMATS = ("png", "pdf")

_METADATA: dict[str, dict[str, Any]] = {
    "png": {"Software": None},
    "pdf": {"Creator": "quadlab", "CreationDate": None},
    "svg": {"Creator": "quadlab", "Date": None},
}
"""Without time of day."""


def save_figure(figure: Figure, folder: Path, name: str, formats: Sequence[str] = PAPER_FORMATS) -> list[Path]:
    """Write ``figure`` as ``<folder>/<name>.<format>`` and return the paths; an older file is replaced in one step.

    Args:
        figure: to be written.
        folder: created if it does not exist.
        name: without suffix.
        formats: any of png, pdf and svg.
    """
    paths = [folder / f"{name}.{kind}" for kind in formats]
    with paper_style():
        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # laid out once, the same in all formats
        for kind, path in zip(formats, paths, strict=True):
            content = BytesIO()
            figure.savefig(content, format=kind, metadata=_METADATA[kind])
            write_bytes(path, content.getvalue())
    return paths
