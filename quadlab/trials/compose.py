"""From YAML files and command-line overrides to a validated trial: what comes after sees no omegaconf."""

from collections.abc import Sequence
from typing import Any, TypeVar

from hydra import compose, initialize_config_dir
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException
from pydantic import ValidationError

from quadlab.configuration import StrictModel
from quadlab.errors import ConfigurationError
from quadlab.paths import CONF_DIR
from quadlab.trials.config import RunOptions, TrialConfig
from quadlab.trials.override_problems import COMPOSITION_ERRORS, UNTYPED_COMPOSITION_ERRORS, composition_problem
from quadlab.trials.problems import validation_problems

ROOT_NAME = "trial"
SWEEP_KEYS = ("pool", "slurm", "shard")
"""What a document says about running many trials; a single trial has no use for it."""

_Model = TypeVar("_Model", bound=StrictModel)


def compose_trial(overrides: Sequence[str] = ()) -> TrialConfig:
    """Return the trial that the command line with these overrides would run.

    Args:
        overrides: as on the command line, e.g. ``["gait=walk", "duration_s=12"]``.

    Raises:
        ConfigurationError: if an override or a value is wrong.
    """
    return split_document(compose_document(overrides))[0]


def compose_document(overrides: Sequence[str] = ()) -> DictConfig:
    """Return the composed YAML, not validated.

    Raises:
        ConfigurationError: if an override names something that does not exist.
    """
    try:
        with initialize_config_dir(version_base="1.3", config_dir=str(CONF_DIR)):
            return compose(ROOT_NAME, overrides=list(overrides))
    except (*COMPOSITION_ERRORS, *UNTYPED_COMPOSITION_ERRORS) as error:
        raise ConfigurationError(composition_problem(error)) from error


def split_document(document: DictConfig) -> tuple[TrialConfig, RunOptions]:
    """Return what a composed document says: the trial, and how to run it.

    Raises:
        ConfigurationError: with one line for each mistake.
    """
    values = plain_values(document)
    for key in SWEEP_KEYS:
        values.pop(key, None)
    options = {key: values.pop(key) for key in RunOptions.model_fields if key in values}
    return validated(TrialConfig, values), validated(RunOptions, options)


def sweep_values(document: DictConfig) -> dict[str, Any]:
    """Return what a composed document says about running many trials.

    Raises:
        ConfigurationError: if a value cannot be resolved.
    """
    values = plain_values(document)
    return {key: values[key] for key in SWEEP_KEYS if key in values}


def plain_values(document: DictConfig) -> dict[str, Any]:
    """Return a composed document as dictionaries, lists and values.

    Raises:
        ConfigurationError: if a value cannot be resolved.
    """
    try:
        values: Any = OmegaConf.to_container(document, resolve=True, throw_on_missing=True)
    except OmegaConfBaseException as error:
        raise ConfigurationError(composition_problem(error)) from error
    return dict(values)


def validated(model: type[_Model], values: dict[str, Any]) -> _Model:
    """Return ``values`` as a ``model``.

    Raises:
        ConfigurationError: with one line for each mistake.
    """
    try:
        return model.model_validate(values)
    except ValidationError as error:
        raise ConfigurationError("\n".join(validation_problems(model, error))) from error
