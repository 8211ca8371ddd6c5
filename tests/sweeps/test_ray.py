"""The same sweep on a Ray cluster of one node; runs where ``pip install "ray<3" hydra-ray-launcher`` was done.

Both are no part of the locked packages, since they pin others.
"""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from sweep_cases import STANDING, state_hashes

from quadlab.sweeps.main import main

pytest.importorskip("ray")
pytest.importorskip("hydra_plugins.hydra_ray_launcher")
RAY = (sys.executable, "-m", "ray.scripts.scripts")
ENTRY = (sys.executable, "-c", "import sys; from quadlab.cli import main; sys.exit(main())")


@pytest.fixture
def cluster() -> Iterator[None]:
    """A head node on this machine."""
    subprocess.run([*RAY, "start", "--head", "--num-cpus=2", "--include-dashboard=false"], check=True)
    yield
    subprocess.run([*RAY, "stop", "--force"], check=True)


@pytest.mark.usefixtures("cluster")
def test_sweep_on_ray_gives_what_the_pool_gives(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    sweep = ["-m", *STANDING, "seed=0,1"]
    subprocess.run([*ENTRY, "run", *sweep, "launcher=ray", "results_dir=there"], check=True)
    assert main([*sweep, "results_dir=here"]) == 0
    assert len(state_hashes(tmp_path / "here")) == 2
    assert state_hashes(tmp_path / "there") == state_hashes(tmp_path / "here")
