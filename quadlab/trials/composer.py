"""Composing many trials that share most of their YAML: each combination of files is read once."""

import copy
from collections import OrderedDict
from collections.abc import Sequence

from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override, OverrideType
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from quadlab.errors import ConfigurationError
from quadlab.paths import CONF_DIR
from quadlab.trials.compose import compose_document
from quadlab.trials.override_problems import COMPOSITION_ERRORS, UNTYPED_COMPOSITION_ERRORS

_KEPT = 64
"""Documents kept at a time."""


class Composer:
    """Composes documents; what it returns is what ``compose_document`` returns, sooner where files repeat.

    Overrides such as ``gait=walk`` choose files and are composed by Hydra, once. Those such as ``seed=3`` are put into
    a copy of that, as Hydra does at the end of a composition. Where one of the overrides is anything else, such as
    ``+a=1`` or ``~a``, or wrong, Hydra does all of it. Files must not change in the meantime.
    """

    def __init__(self) -> None:
        self._parser = OverridesParser.create()
        self._parsed: dict[str, Override] = {}
        self._documents: OrderedDict[tuple[str, ...], DictConfig] = OrderedDict()

    def compose(self, overrides: Sequence[str]) -> DictConfig:
        """Return the composed YAML, not validated.

        Raises:
            ConfigurationError: if an override names something that does not exist.
        """
        try:
            parsed = [self._parse(override) for override in overrides]
            if all(_chooses_files(override) or _sets_a_value(override) for override in parsed):
                return self._compose(parsed)
        except (ConfigurationError, OmegaConfBaseException, *COMPOSITION_ERRORS, *UNTYPED_COMPOSITION_ERRORS):
            pass  # Hydra says best what is wrong
        return compose_document(overrides)

    def _parse(self, override: str) -> Override:
        if override not in self._parsed:
            self._parsed[override] = self._parser.parse_override(override)
        return self._parsed[override]

    def _compose(self, overrides: Sequence[Override]) -> DictConfig:
        document = copy.deepcopy(self._chosen(tuple(str(o.input_line) for o in overrides if _chooses_files(o))))
        for override in filter(_sets_a_value, overrides):
            OmegaConf.update(document, override.key_or_group, override.value(), merge=True)
        return document

    def _chosen(self, choices: tuple[str, ...]) -> DictConfig:
        """Return the document of the files that are chosen."""
        document = self._documents.pop(choices, None)
        self._documents[choices] = compose_document(choices) if document is None else document
        while len(self._documents) > _KEPT:
            self._documents.popitem(last=False)
        return self._documents[choices]


def _chooses_files(override: Override) -> bool:
    """Whether an override is one such as ``gait=walk``."""
    return _is_plain(override) and _is_group(override.key_or_group) and not isinstance(override.value(), dict)


def _sets_a_value(override: Override) -> bool:
    """Whether an override is one such as ``seed=3``."""
    return _is_plain(override) and not _is_group(override.key_or_group)


def _is_plain(override: Override) -> bool:
    changes = override.type is OverrideType.CHANGE and override.package is None
    return changes and not override.is_sweep_override() and not override.key_or_group.startswith("hydra")


def _is_group(key: str) -> bool:
    return (CONF_DIR / key).is_dir()
