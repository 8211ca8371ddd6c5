"""Commands that run no trial do not load what only trials need, so that they answer at once."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

PHYSICS = {"mujoco", "casadi", "pinocchio", "numba", "scipy.optimize", "scipy.stats"}
TABLES = {"pandas", "pyarrow", "matplotlib"}
HYDRA = {"hydra", "omegaconf", "antlr4"}
HELP = "import contextlib; from quadlab.cli import main\nwith contextlib.suppress(SystemExit): main(['--help'])"


@pytest.mark.parametrize(
    ("code", "forbidden"),
    [
        (HELP, PHYSICS | TABLES | HYDRA | {"numpy", "pydantic"}),
        ("from quadlab.cli import main; main(['run', '--cfg', 'job'])", PHYSICS | TABLES | {"numpy"}),
        ("import quadlab.studies.main", PHYSICS | TABLES | HYDRA),
        ("from paper_figures.reproduction import main; main(['artefact=none'])", PHYSICS | HYDRA),
    ],
)
def test_nothing_heavy_is_imported(code: str, forbidden: set[str], tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in [os.getcwd(), *sys.path] if path)}
    script = f"{code}\nimport sys; print('imported:', *sorted({forbidden!r} & set(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines()[-1] == "imported:"
