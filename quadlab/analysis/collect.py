"""The results of many trials in one typed table, with what was varied, for pandas, R or a spreadsheet."""

import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, get_args

import pandas as pd

from quadlab.analysis.collection import COMMIT, Collection
from quadlab.analysis.inventory import EntryState, TrialEntry, trial_entries
from quadlab.errors import LogError
from quadlab.trials.files import unfinished_path, write_text
from quadlab.trials.result import TrialResult, TrialStatus

INDEX = "trial_id"
PARQUET, CSV = "trials.parquet", "trials.csv"
_WITHOUT_OUTCOME = (EntryState.RUNNING, EntryState.UNFINISHED)
_NAMED_PARTS = ("robot", "gait", "planner", "controller", "scenario")
_UNKNOWN = "unknown"
_TYPES = {int: "Int64", float: "Float64", bool: "boolean", str: "string"}


def collect_trials(folder: Path) -> pd.DataFrame:
    """Return one row for each trial below ``folder`` that has an outcome, indexed by trial id and sorted by it.

    Failures are rows: where the program failed or the result cannot be read the status is ``error``. Columns are the
    fields of ``TrialResult``, the commit, and every value of the configuration that differs between the trials, by its
    dotted key, e.g. ``controller.tracking.alignment.torso``. What does not exist is missing (NA), in every type.

    Raises:
        LogError: if there is nothing to collect, or two trials have the same id.
    """
    return collect(folder).table


def collect(folder: Path) -> Collection:
    """Return the table of ``collect_trials`` together with what is to be known of it.

    Raises:
        LogError: as ``collect_trials``.
    """
    found = trial_entries(folder)
    entries = [entry for entry in found if entry.state not in _WITHOUT_OUTCOME]
    _check_unique(entries)
    if not entries:
        raise LogError(f"{folder}: no trial in it has an outcome yet; 'quadlab status {folder}' says what is there")
    left_out = Counter(entry.state.value for entry in found if entry.state in _WITHOUT_OUTCOME)
    without_config = tuple(entry.trial_id for entry in entries if not entry.config)
    return Collection(_table(entries), without_config, left_out)


def _table(entries: Sequence[TrialEntry]) -> pd.DataFrame:
    results = pd.DataFrame([_row(entry) for entry in entries], columns=list(TrialResult.model_fields))
    results = results.astype({name: _type_of(name) for name in TrialResult.model_fields})
    results[COMMIT] = pd.array([entry.commit for entry in entries], dtype="string")
    table = pd.concat([results, varied_values([entry.config for entry in entries])], axis="columns")
    return table.set_index(INDEX)


def write_collected(table: pd.DataFrame, folder: Path) -> tuple[Path, Path]:
    """Write ``trials.parquet`` and ``trials.csv`` into ``folder``, each in one step, and return their paths."""
    parquet, csv = folder / PARQUET, folder / CSV
    part = unfinished_path(parquet)
    try:
        table.to_parquet(part)
        os.replace(part, parquet)
    finally:
        part.unlink(missing_ok=True)
    write_text(csv, table.to_csv())
    return parquet, csv


def varied_values(configs: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Return one row a configuration and one typed column for each dotted key whose value is not the same in all.

    An empty configuration is an unknown one: a row without values, which makes nothing varied.
    """
    flat = [dict(_leaves(config)) if config else None for config in configs]
    known = [values for values in flat if values is not None]
    keys = {key for values in known for key in values} - set(TrialResult.model_fields)
    varied = [key for key in sorted(keys) if len({repr(values.get(key)) for values in known}) > 1]
    columns = {key: _typed([values and values.get(key) for values in flat]) for key in varied}
    return pd.DataFrame(columns, index=range(len(flat)))


def _check_unique(entries: Sequence[TrialEntry]) -> None:
    for one, other in pairwise(entries):
        if one.trial_id == other.trial_id:
            raise LogError(f"{one.directory} and {other.directory} are the same trial; name one of the two folders")


def _row(entry: TrialEntry) -> dict[str, Any]:
    if entry.result is not None:
        return entry.result.model_dump(mode="json")
    return {
        INDEX: entry.trial_id,
        "status": TrialStatus.ERROR.value,
        "status_reason": entry.reason,
        **{part: _word(entry.config, part, "name") for part in _NAMED_PARTS},
        "estimator": _word(entry.config, "estimator", "kind"),
        "seed": _number(entry.config, "seed", int),
        "duration_s": _number(entry.config, "duration_s", int, float),
    }


def _word(config: Mapping[str, Any], part: str, key: str) -> str:
    values = config.get(part)
    return str(values.get(key, _UNKNOWN)) if isinstance(values, Mapping) else _UNKNOWN


def _number(config: Mapping[str, Any], key: str, *kinds: type) -> Any:
    value = config.get(key)
    return value if type(value) in kinds else None


def _type_of(field: str) -> str:
    annotation = TrialResult.model_fields[field].annotation
    members = [getattr(member, "__origin__", member) for member in get_args(annotation) or (annotation,)]
    kind = next((member for member in members if member in _TYPES), int if field == "schema_version" else str)
    return _TYPES[kind]


def _leaves(value: Any, key: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping) and value:
        children = value.items()
    elif isinstance(value, list) and value:
        children = enumerate(value)  # type: ignore[assignment]
    else:
        yield key, value if value not in ({}, []) else str(value)
        return
    for name, child in children:
        yield from _leaves(child, f"{key}.{name}" if key else str(name))


def _typed(values: Sequence[Any]) -> Any:
    """Return values as the narrowest type that holds all of them; words if nothing else does."""
    kinds = {type(value) for value in values if value is not None}
    for kind in (bool, int, float):
        if kinds <= {kind} or (kind is float and kinds <= {int, float}):
            return pd.array(list(values), dtype=_TYPES[kind])  # type: ignore[call-overload]
    return pd.array([None if value is None else str(value) for value in values], dtype="string")
