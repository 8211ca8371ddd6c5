"""Redraw every figure: ``python -m paper_figures``; each module below this package that has ``draw`` is a figure."""

import importlib
import pkgutil
import sys
from pathlib import Path

import paper_figures
from quadlab.plotting.figure_files import save_figure

FOLDER = Path(__file__).parent


def main() -> int:
    """Draw all figures beside their scripts and print where they are."""
    for module in pkgutil.walk_packages(paper_figures.__path__, "paper_figures."):
        if module.ispkg or module.name.endswith("__main__"):
            continue
        script = importlib.import_module(module.name)
        _, paper, artefact = module.name.split(".")
        for path in save_figure(script.draw(), FOLDER / paper, artefact):
            sys.stdout.write(f"{path.relative_to(FOLDER.parent)}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
