"""What a study remembers: a damaged file is as good as none."""

from pathlib import Path

import pytest

from quadlab.errors import ConfigurationError
from quadlab.studies import config, files
from quadlab.studies.files import StudyFolder, last_row, read_row, remove_trace, write_row


def test_remembered_row_comes_back_for_the_same_settings_only(tmp_path: Path) -> None:
    folder = StudyFolder(tmp_path)
    write_row(folder, "a", "settings", {"x": 1})
    assert read_row(folder, "a", "settings") == {"x": 1}
    assert read_row(folder, "a", "others") is None
    assert last_row(folder, "a") == {"x": 1}
    assert last_row(folder, "b") is None


def _hash_of(folder: Path, monkeypatch: pytest.MonkeyPatch, **contents: str) -> str:
    for name, text in contents.items():
        path = folder / name / "a.yaml"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    monkeypatch.setattr(files, "CONF_DIR", folder)
    return files.configuration_hash()


@pytest.mark.parametrize(
    ("changed", "same"),
    [
        ({"gait": "b: 1 # why"}, True),
        ({"study": "title: other"}, True),
        ({"launcher": "workers: 3"}, True),
        ({"gait": "b: 2"}, False),
        ({"gait": "# @package _global_\nb: 1"}, False),
        ({"gait": "b: [1"}, False),
    ],
)
def test_only_what_trials_are_made_of_makes_rows_stale(
    changed: dict[str, str], same: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = _hash_of(tmp_path, monkeypatch, gait="b: 1", study="title: one", launcher="workers: 2")
    assert (_hash_of(tmp_path, monkeypatch, **changed) == before) is same


@pytest.mark.parametrize("content", [b"\xff", b"{", b"[1]", b'{"settings": "s"}', b'{"settings": "s", "row": 3}'])
def test_damaged_row_is_made_again(tmp_path: Path, content: bytes) -> None:
    folder = StudyFolder(tmp_path)
    write_row(folder, "a", "s", {})
    folder.row("a").write_bytes(content)
    assert read_row(folder, "a", "s") is None


def test_trace_is_removed_with_all_its_pictures_and_no_other(tmp_path: Path) -> None:
    gone = ["a[1].parquet", "a[1].events.csv", "a[1].00.png", "a[1].11.png"]
    stay = ["a1.parquet", "a1.00.png", "a[1]_2.parquet", "a[1].b.parquet", "a[1].b.00.png"]
    for name in (*gone, *stay):
        (tmp_path / "traces").mkdir(exist_ok=True)
        (tmp_path / "traces" / name).touch()
    remove_trace("a[1]", StudyFolder(tmp_path))
    assert sorted(path.name for path in (tmp_path / "traces").iterdir()) == sorted(stay)
    remove_trace("b", StudyFolder(tmp_path / "nowhere"))


def test_study_that_is_no_text_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "study").mkdir()
    (tmp_path / "study/x.yaml").write_bytes(b"title: \xff")
    monkeypatch.setattr(config, "CONF_DIR", tmp_path)
    with pytest.raises(ConfigurationError, match=r"^study/x\.yaml: not UTF-8 \(.*\)$"):
        config.load_study("x")
