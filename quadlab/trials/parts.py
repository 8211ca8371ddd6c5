"""Exchangeable parts in a configuration: the model is chosen by ``kind`` from what is registered."""

from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from quadlab.configuration import registered


@dataclass(frozen=True)
class PartOf:
    """Annotation of a field that holds the ``Config`` of any part registered under ``group``.

    The parts must be registered (their modules imported) before the model with this field is defined.
    """

    group: str

    def models(self) -> dict[str, Any]:
        """Return the configuration models of the group, by kind."""
        return {kind: part.Config for kind, part in registered(self.group).items()}  # type: ignore[attr-defined]

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Return the union of the registered models, told apart by their ``kind``."""
        choices = {kind: handler.generate_schema(model) for kind, model in self.models().items()}
        return core_schema.tagged_union_schema(choices, discriminator="kind")
