"""A file is there as a whole or as it was before."""

import os
from pathlib import Path

import pytest

from quadlab.trials.files import write_bytes, write_text


def test_content_is_what_was_written(tmp_path: Path) -> None:
    write_bytes(tmp_path / "folder" / "a", b"\x00\xff\r\n")
    assert (tmp_path / "folder" / "a").read_bytes() == b"\x00\xff\r\n"
    write_text(tmp_path / "b", "\u00e4\n")
    assert (tmp_path / "b").read_bytes() == b"\xc3\xa4\n"


def test_old_file_stays_if_writing_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_: int) -> None:
        raise OSError("disk full")

    write_bytes(tmp_path / "a", b"old")
    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(OSError, match="disk full"):
        write_bytes(tmp_path / "a", b"new")
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"old"]
