"""Videos play everywhere and have the right length; strips are laid out as asked."""

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from rendering_cases import SMALL, scenario

from quadlab.errors import MissingDependencyError, QuadlabError
from quadlab.robots.model import RobotModel
from quadlab.simulation.rendering.motion import Motion
from quadlab.simulation.rendering.offscreen import Frame
from quadlab.simulation.rendering.strip import GAP_PIXELS, snapshot_strip
from quadlab.simulation.rendering.trial_render import render_trial, snapshot_times, video_times
from quadlab.simulation.rendering.video import ffmpeg_program, write_video


def plain(count: int, width: int = 64, height: int = 48) -> list[Frame]:
    return [np.full((height, width, 3), 20 * k, np.uint8) for k in range(count)]


@pytest.fixture
def requires_ffmpeg() -> None:
    try:
        ffmpeg_program()
    except MissingDependencyError as error:
        pytest.skip(str(error))


def decoded(path: Path, width: int, height: int) -> Frame:
    command = [ffmpeg_program(), "-loglevel", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    output = subprocess.run(command, check=True, capture_output=True).stdout
    return np.frombuffer(output, np.uint8).reshape(-1, height, width, 3)


def described(path: Path) -> str:
    return subprocess.run([ffmpeg_program(), "-i", str(path)], check=False, capture_output=True, text=True).stderr


@pytest.mark.usefixtures("requires_ffmpeg")
def test_video_holds_every_frame_in_a_format_that_plays_everywhere(tmp_path: Path) -> None:
    path = tmp_path / "video.mp4"
    assert write_video(iter(plain(10)), path, fps=25.0) == 10
    frames = decoded(path, 64, 48)
    assert frames.mean(axis=(1, 2, 3)) == pytest.approx([20 * k for k in range(10)], abs=6)
    text = described(path)
    assert "h264" in text
    assert "yuv420p" in text
    duration = re.search(r"Duration: 00:00:(\d+\.\d+)", text)
    assert duration is not None
    assert float(duration.group(1)) == pytest.approx(0.4, abs=0.011)
    assert [file.name for file in tmp_path.iterdir()] == ["video.mp4"]


@pytest.mark.usefixtures("requires_ffmpeg")
def test_failed_video_leaves_the_old_one_and_no_part(tmp_path: Path) -> None:
    path = tmp_path / "video.mp4"
    path.write_text("the old one")

    def breaking() -> Iterator[Frame]:
        yield from plain(3)
        raise QuadlabError("the renderer stopped")

    with pytest.raises(QuadlabError, match="the renderer stopped"):
        write_video(breaking(), path, fps=25.0)
    with pytest.raises(QuadlabError, match="expected shape"):
        write_video([*plain(2), *plain(1, width=32)], path, fps=25.0)
    with pytest.raises(QuadlabError, match="ffmpeg failed"):
        write_video(plain(2, width=63, height=47), path, fps=25.0)
    with pytest.raises(QuadlabError, match="no frames"):
        write_video([], path, fps=25.0)
    assert path.read_text() == "the old one"
    assert [file.name for file in tmp_path.iterdir()] == ["video.mp4"]


def test_missing_ffmpeg_is_one_line_that_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda _: None)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(MissingDependencyError, match=r"quadlab\[video\]") as caught:
        ffmpeg_program()
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("count", "columns", "shape"), [(4, 2, (2, 2)), (5, 2, (3, 2)), (3, 8, (1, 3)), (1, 1, (1, 1))]
)
def test_strip_layout(count: int, columns: int, shape: tuple[int, int]) -> None:
    frames = plain(count, width=120, height=80)
    strip = snapshot_strip(frames, [f"{k} s" for k in range(count)], columns)
    rows, used_columns = shape
    assert strip.shape == (rows * 80 + (rows - 1) * GAP_PIXELS, used_columns * 120 + (used_columns - 1) * GAP_PIXELS, 3)
    for k, frame in enumerate(frames):
        row, column = divmod(k, used_columns)
        top, left = row * (80 + GAP_PIXELS), column * (120 + GAP_PIXELS)
        tile = strip[top : top + 80, left : left + 120]
        assert np.array_equal(tile[40:], frame[40:])
        assert not np.array_equal(tile[:40], frame[:40]), "no label"


def test_strip_needs_a_label_for_each_frame() -> None:
    with pytest.raises(QuadlabError, match="2 labels for 3 frames"):
        snapshot_strip(plain(3), ["a", "b"], 2)


def test_slow_motion_has_more_frames_of_the_same_trial(motion: Motion) -> None:
    usual, slow = (video_times(motion, SMALL.model_copy(update={"slow_down": factor})) for factor in (1.0, 4.0))
    assert (usual[0], usual[-1]) == pytest.approx(motion.span)
    assert (slow[0], slow[-1]) == pytest.approx(motion.span)
    assert len(slow) - 1 == 4 * (len(usual) - 1)


def test_a_snapshot_shows_the_push(motion: Motion) -> None:
    push = {"body": "base", "direction": (0, 1, 0), "force_n": 100.0, "start_s": 0.6, "duration_s": 0.1}
    times_s = snapshot_times(motion, scenario(pushes=[push]), SMALL)
    assert np.any((times_s >= 0.6) & (times_s < 0.7))
    assert len(times_s) == SMALL.snapshots


@pytest.mark.usefixtures("requires_egl", "requires_ffmpeg")
def test_trial_becomes_video_and_strip(tmp_path: Path, anymal: RobotModel, motion: Motion) -> None:
    result = render_trial(anymal, scenario(), motion, tmp_path / "new", SMALL)
    assert result.frames == 11
    assert len(decoded(result.video, SMALL.width, SMALL.height)) == 11
    with Image.open(result.strip) as strip:
        assert strip.size == (3 * SMALL.width + 2 * GAP_PIXELS, SMALL.height)
    assert sorted(file.name for file in (tmp_path / "new").iterdir()) == ["strip.png", "video.mp4"]
