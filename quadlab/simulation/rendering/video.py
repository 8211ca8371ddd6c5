"""Videos from frames, written by ffmpeg: mp4 with H.264, which every browser and slide program plays."""

import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import IO

from quadlab.errors import MissingDependencyError, QuadlabError
from quadlab.simulation.rendering.offscreen import Frame

QUALITY_CRF = 20
"""Constant rate factor of x264: 0 is lossless, 51 is worst; about 20 looks clean."""


def ffmpeg_program() -> str:
    """Return the path of ffmpeg: the system's, else the one of the package imageio-ffmpeg.

    Raises:
        MissingDependencyError: if there is neither.
    """
    system = shutil.which("ffmpeg")
    if system is not None:
        return system
    try:
        import imageio_ffmpeg  # noqa: PLC0415 - optional, and only needed without a system ffmpeg

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except (ImportError, RuntimeError) as error:
        raise MissingDependencyError(
            f"writing a video needs ffmpeg ({error}); install it (apt-get install ffmpeg) or run: "
            "pip install 'quadlab[video]'"
        ) from error


def write_video(frames: Iterable[Frame], path: Path, fps: float) -> int:
    """Write frames of one even size to an mp4 file and return their number.

    The file appears under its name only when it is complete.

    Args:
        frames: (height, width, 3) each; may be an iterator, nothing is kept.
        path: of the video; its folder must exist.
        fps: frames per second in [Hz].

    Raises:
        MissingDependencyError: if there is no ffmpeg.
        QuadlabError: if there are no frames, their sizes differ, or ffmpeg fails.
    """
    iterator = iter(frames)
    first = next(iterator, None)
    if first is None:
        raise QuadlabError(f"{path}: no frames to write")
    part = path.with_name(f"{path.name}.part")
    try:
        count = _encode(chain([first], iterator), first, part, fps)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
    return count


def _encode(frames: Iterator[Frame], first: Frame, part: Path, fps: float) -> int:
    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(_command(first, part, fps), stdin=subprocess.PIPE, stderr=errors)
        complete = False
        try:
            count = _feed(process.stdin, frames, first.shape)
            complete = True
        finally:
            if not complete:
                process.kill()
            process.wait()
        if process.returncode != 0:
            errors.seek(0)
            reason = " ".join(errors.read().decode(errors="replace").split())
            raise QuadlabError(f"{part}: ffmpeg failed with code {process.returncode}: {reason}")
    return count


def _feed(pipe: IO[bytes] | None, frames: Iterator[Frame], shape: tuple[int, ...]) -> int:
    """Write frames to ffmpeg; if it has stopped reading, its exit code tells why."""
    count = 0
    if pipe is None:
        return count
    try:
        for frame in frames:
            if frame.shape != shape:
                raise QuadlabError(f"frame {count}: expected shape {shape}, found {frame.shape}")
            pipe.write(frame.tobytes())
            count += 1
        pipe.close()
    except BrokenPipeError:
        return count
    return count


def _command(frame: Frame, part: Path, fps: float) -> list[str]:
    height, width = frame.shape[:2]
    source = f"-f rawvideo -pix_fmt rgb24 -s {width}x{height} -r {fps:g} -i -"
    target = f"-an -c:v libx264 -preset veryfast -crf {QUALITY_CRF} -pix_fmt yuv420p -movflags +faststart -f mp4"
    return [ffmpeg_program(), "-y", "-loglevel", "error", *source.split(), *target.split(), str(part)]
