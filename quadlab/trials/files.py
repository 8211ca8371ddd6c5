"""Writing result files so that a reader never sees half of one."""

import json
import os
import secrets
from pathlib import Path
from typing import Any


def unfinished_path(path: Path, suffix: str = ".part") -> Path:
    """Return where ``path`` is while it is being written: a name that no other process, machine or thread takes."""
    return path.with_name(f"{path.name}.{os.getpid()}-{secrets.token_hex(4)}{suffix}")


def write_text(path: Path, text: str) -> None:
    """Write ``text`` to ``path`` in one step, see ``write_bytes``."""
    write_bytes(path, text.encode())


def write_bytes(path: Path, content: bytes) -> None:
    """Write ``content`` to ``path`` in one step: either the old file is there or the whole new one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = unfinished_path(path)
    try:
        with part.open("wb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def write_json(path: Path, content: Any) -> None:
    """Write ``content`` as indented JSON in one step.

    Raises:
        ValueError: if a number is NaN or infinite; the old file, if any, is untouched.
    """
    write_text(path, json.dumps(content, indent=2, allow_nan=False) + "\n")
