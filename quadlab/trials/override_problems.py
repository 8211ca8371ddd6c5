"""Mistakes that Hydra finds while it composes the configuration, in one line each."""

import re
from collections.abc import Mapping

import yaml
from hydra.errors import HydraException, MissingConfigException, OverrideParseException
from omegaconf.errors import OmegaConfBaseException

from quadlab.paths import CONF_DIR
from quadlab.trials.problems import suggestion

COMPOSITION_ERRORS = (HydraException, OmegaConfBaseException, yaml.YAMLError)
"""What Hydra raises for wrong overrides and wrong files."""

UNTYPED_COMPOSITION_ERRORS = (ValueError, TypeError, AssertionError, OSError)
"""What it raises for an override without a name, for a word where the number of a list entry belongs, for an entry of a
list that shall be removed, and for a name that is longer than a file's may be."""

_LONGEST_PATH = 300
_SEVERAL_VALUES = re.compile(r"Ambiguous value for argument '(.+)'$|Sweep parameters '(.+)' requires --multirun")
"""What Hydra says first of ``gait=walk,trot`` and of ``seed=range(0,3)`` where a single trial is run."""


def composition_problem(error: Exception) -> str:
    """Return one line that says what is wrong with an override or a YAML file, and what exists.

    Args:
        error: what Hydra or OmegaConf raised while composing.
    """
    match error:
        case MissingConfigException() if error.missing_cfg_file:
            problem = _unknown_option(error)
        case OverrideParseException():
            problem = f"{error.override}: cannot be read as key=value ({_first_line(error.message)})"
        case yaml.MarkedYAMLError() if error.problem_mark:
            problem = f"{error.problem_mark.name}, line {error.problem_mark.line + 1}: {error.problem}"
        case AssertionError():
            problem = "an override has no key; expected key=value, +key=value or ~key"
        case TypeError() if str(error).startswith("list indices"):
            problem = "~ takes no entry out of a list; override the whole list, or leave the entry out in a file"
        case OSError():
            problem = f"{str(error.filename)[:_LONGEST_PATH]}: {error.strerror}"
        case _ if isinstance(error.__cause__, OmegaConfBaseException):
            problem = _unknown_key(error.__cause__) or f"{_first_line(error)}: {_first_line(error.__cause__)}"
        case _ if _first_line(error).startswith("Could not override 'study'"):
            problem = "study: no part of a trial; it is run by python experiments/run_study.py <name>"
        case _ if several := _SEVERAL_VALUES.match(_first_line(error)):
            problem = _several_values(several[1] or several[2])
        case _:
            problem = _first_line(error)
    return problem


def _unknown_option(error: MissingConfigException) -> str:
    """Return the line for ``group=option`` where the option or the whole group does not exist."""
    group, _, option = str(error.missing_cfg_file).rpartition("/")
    if error.options is None:
        return f"{error.missing_cfg_file}: no such configuration file"
    hint = "; others are packages, e.g. pip install hydra-ray-launcher" if group == "hydra/launcher" else ""
    if group == "experiment" and (CONF_DIR / "study" / f"{option}.yaml").is_file():
        hint = f"; '{option}' is a study: python experiments/run_study.py {option}"
    return f"{group}: unknown '{option}'; {suggestion(option, error.options)}{hint}"


def _several_values(override: str) -> str:
    """Return the line for an override that only a sweep can have."""
    key, _, values = override.partition("=")
    listed = "" if "(" in values else f", or write {key}=[{values}] for a list"
    return f"{override}: several values; add -m for a sweep{listed}"


def _unknown_key(cause: OmegaConfBaseException) -> str | None:
    """Return the line for ``key=value`` where the key does not exist."""
    if not isinstance(cause.parent_node, Mapping) or cause.full_key is None:
        return None
    known = [str(key) for key in cause.parent_node if key != "hydra"]
    left_out = "; an option of a task that its file leaves out takes a + in front" if "task" in known else ""
    return f"{cause.full_key}: unknown key; {suggestion(str(cause.key), known)}{left_out}"


def _first_line(problem: object) -> str:
    return next(iter(str(problem).splitlines()), type(problem).__name__).strip()
