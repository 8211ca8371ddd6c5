"""Run every experiment of the papers and redraw their tables and figures.

    python experiments/reproduce.py paper=all [jobs=2] [artefact=figure6]

``paper`` is gehring2017, winkler2017, bellicoso2016, comparison or all. What was done before is not run again.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))  # paper_figures is no part of the installed package

from paper_figures.reproduction import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
