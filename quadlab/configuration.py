"""The base of every configuration model and the registry of exchangeable parts.

Values live in YAML, types and ranges in a model beside the class that uses them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from quadlab.errors import ConfigurationError


class StrictModel(BaseModel):
    """A frozen configuration: unknown keys, NaN and infinity are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


def without_defaults(config: StrictModel) -> dict[str, Any]:
    """Return what ``config`` says beyond its defaults.

    Serialised like this, a new option leaves the identity of trials as it is that know nothing of it.
    """
    return config.model_dump(exclude_defaults=True)


Positive = Annotated[float, Field(gt=0.0)]
NonNegative = Annotated[float, Field(ge=0.0)]
Fraction = Annotated[float, Field(ge=0.0, le=1.0)]
Vector2 = Annotated[tuple[float, ...], Field(min_length=2, max_length=2)]
Vector3 = Annotated[tuple[float, ...], Field(min_length=3, max_length=3)]

_Part = TypeVar("_Part", bound=type)
_REGISTRY: dict[str, dict[str, type]] = {}


def register(group: str, kind: str) -> Callable[[_Part], _Part]:
    """Class decorator: make a class selectable by ``kind: <kind>`` in the YAML of ``group``.

    The class has a ``Config`` attribute, a StrictModel with a field ``kind: Literal[<kind>]``.
    """

    def decorate(part: _Part) -> _Part:
        _REGISTRY.setdefault(group, {})[kind] = part
        return part

    return decorate


def registered(group: str) -> dict[str, type]:
    """Return the classes registered under ``group``, by kind."""
    return dict(_REGISTRY.get(group, {}))


def part_of(group: str, config: Any) -> type:
    """Return the class whose ``Config`` has the ``kind`` of ``config``.

    Raises:
        ConfigurationError: if no such kind is registered.
    """
    known = registered(group)
    if config.kind not in known:
        raise ConfigurationError(f"{group}.kind: unknown '{config.kind}'; known: {', '.join(sorted(known))}")
    return known[config.kind]


@dataclass(frozen=True)
class PartOf:
    """Annotation of a field that holds the ``Config`` of any part registered under ``group``.

    The parts must be registered (their modules imported) before the model with this field is defined.

    Attributes:
        group: of the parts.
        key: of the YAML that names the part.
    """

    group: str
    key: str = "kind"

    def models(self) -> dict[str, Any]:
        """Return the configuration models of the group, by kind."""
        return {kind: part.Config for kind, part in registered(self.group).items()}  # type: ignore[attr-defined]

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Return the union of the registered models, told apart by their ``key``."""
        choices = {kind: handler.generate_schema(model) for kind, model in self.models().items()}
        return core_schema.tagged_union_schema(choices, discriminator=self.key)
