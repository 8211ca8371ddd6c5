"""A strip of snapshots: pictures of chosen moments side by side, each with its time."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from quadlab.errors import QuadlabError
from quadlab.simulation.rendering.offscreen import Frame

GAP_PIXELS = 6
LABEL_SHARE = 0.06
"""Height of the label's letters as a share of the picture's height."""

PAPER, INK = (255, 255, 255), (40, 40, 40)


def snapshot_strip(frames: Sequence[Frame], labels: Sequence[str], columns: int) -> Frame:
    """Return the frames in rows of ``columns``, each labelled in its upper left corner, (height, width, 3).

    Args:
        frames: of one size, (h, w, 3).
        labels: one for each frame.
        columns: pictures in a row; the last row may hold fewer.

    Raises:
        QuadlabError: if there are no frames, or not one label for each.
    """
    if not frames or len(frames) != len(labels):
        raise QuadlabError(f"strip: expected one label for each of at least one frame, got {len(labels)} labels "
                           f"for {len(frames)} frames")  # fmt: skip
    height, width = frames[0].shape[:2]
    columns = min(columns, len(frames))
    rows = -(-len(frames) // columns)
    size = (columns * (width + GAP_PIXELS) - GAP_PIXELS, rows * (height + GAP_PIXELS) - GAP_PIXELS)
    strip = Image.new("RGB", size, PAPER)
    for index, (frame, label) in enumerate(zip(frames, labels, strict=True)):
        row, column = divmod(index, columns)
        corner = (column * (width + GAP_PIXELS), row * (height + GAP_PIXELS))
        strip.paste(_labelled(frame, label), corner)
    return np.asarray(strip)


def write_png(picture: Frame, path: Path) -> None:
    """Write a picture, (height, width, 3); the file appears under its name only when it is complete."""
    part = path.with_name(f"{path.name}.part")
    Image.fromarray(picture).save(part, format="PNG", optimize=True)
    part.replace(path)


def _labelled(frame: Frame, label: str) -> Image.Image:
    picture = Image.fromarray(frame)
    letter_height = max(10, round(LABEL_SHARE * picture.height))
    corner = (letter_height // 2, letter_height // 3)
    font = ImageFont.load_default(letter_height)
    ImageDraw.Draw(picture).text(corner, label, fill=INK, font=font, stroke_width=1, stroke_fill=PAPER)
    return picture
