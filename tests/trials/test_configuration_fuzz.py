"""Broken overrides and files are refused in lines, never by a traceback; more of them in the script."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "experiments" / "fuzz_configuration.py"


@pytest.mark.skipif(not SCRIPT.is_file(), reason="needs a source tree")
def test_broken_overrides_and_files_are_refused_in_lines() -> None:
    command = [sys.executable, str(SCRIPT), "--cases", "200", "--seed", "1"]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.stdout == "200 cases, 0 answered badly\n", done.stdout + done.stderr
