"""A figure file is the old one or the whole new one."""

from pathlib import Path

import pytest
from matplotlib.figure import Figure

from quadlab.plotting.figure_files import save_figure


def _break(self: Figure, stream: object, **_: object) -> None:
    raise KeyboardInterrupt


def test_figure_that_is_interrupted_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (path,) = save_figure(Figure(figsize=(1.0, 1.0)), tmp_path / "new folder", "empty", ["png"])
    before = path.read_bytes()
    monkeypatch.setattr(Figure, "savefig", _break)
    with pytest.raises(KeyboardInterrupt):
        save_figure(Figure(figsize=(2.0, 2.0)), path.parent, "empty", ["png"])
    assert path.read_bytes() == before
    assert [*path.parent.iterdir()] == [path]
