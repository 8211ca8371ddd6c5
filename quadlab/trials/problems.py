"""What is wrong with a configuration, in lines that a person can act on."""

import difflib
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from quadlab.configuration import PartOf

_SHOWN = 25
"""That many names are still read; the robots, gaits and studies of quadlab are fewer."""
_LONGEST = 200
"""What was given is not repeated if it is longer, such as all levels of a controller."""


def suggestion(name: str, known: Iterable[str]) -> str:
    """Return "did you mean 'x'?; known: a, b, x" for a name that is not one of ``known``; of many, the first."""
    options = sorted(known)
    more = f" and {len(options) - _SHOWN} more" if len(options) > _SHOWN else ""
    return f"{did_you_mean(name, options)}known: {', '.join(options[:_SHOWN]) or 'none'}{more}"


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return "did you mean 'x'?; ", or nothing if none of ``known`` is like ``name``."""
    near = difflib.get_close_matches(name, list(known), 1)
    return f"did you mean '{near[0]}'?; " if near else ""


def validation_problems(model: type[BaseModel], error: ValidationError) -> list[str]:
    """Return one line for each mistake that ``model`` found: key, what is wrong, what was given, what exists."""
    found = error.errors(include_url=False)
    return [_problem(model, details) for details in found if not _follows_from_others(details, found)]


def _follows_from_others(details: Mapping[str, Any], found: Iterable[Mapping[str, Any]]) -> bool:
    """Whether a list is said to be too short since pydantic leaves out the entries with mistakes of their own."""
    place = details["loc"]
    return details["type"] == "too_short" and any(
        len(other["loc"]) > len(place) and other["loc"][: len(place)] == place for other in found
    )


def _problem(model: type[BaseModel], details: Mapping[str, Any]) -> str:
    path, parent = _follow(model, details["loc"])
    given = details["input"]
    match details["type"]:
        case "extra_forbidden":
            return f"{path}: unknown key; {suggestion(str(details['loc'][-1]), _keys(parent))}"
        case "missing":
            return f"{path}: missing"
        case "union_tag_invalid":
            key, kinds = _key(details), [kind.strip(" '") for kind in details["ctx"]["expected_tags"].split(",")]
            return f"{path}.{key}: unknown '{details['ctx']['tag']}'; {suggestion(details['ctx']['tag'], kinds)}"
        case "union_tag_not_found":
            return f"{path}.{_key(details)}: missing"
    message = details["msg"].removeprefix("Value error, ")
    text = "" if isinstance(given, dict | BaseModel) else repr(given)
    shown = f" (got {text})" if text and len(text) <= _LONGEST else ""
    return f"{path}: {message[0].lower()}{message[1:]}{shown}"


def _key(details: Mapping[str, Any]) -> str:
    """Return the key by which the members of a union are told apart."""
    return str(details["ctx"]["discriminator"]).strip("'")


def _follow(model: type[BaseModel], location: tuple[int | str, ...]) -> tuple[str, Any]:
    """Return the key as written in YAML, without pydantic's union tags, and the type that holds its last part."""
    path, parent, here = "", model, model
    for step in location:
        if _is_tag(here, step):
            here = _choice(here, step)
            continue
        path += f"[{step}]" if isinstance(step, int) else f".{step}"
        parent, here = here, _child(here, step)
    return path.removeprefix("."), parent


def _fields(kind: Any) -> Mapping[str, Any]:
    return kind.model_fields if isinstance(kind, type) and issubclass(kind, BaseModel) else {}


def _keys(kind: Any) -> Iterable[str]:
    return _fields(kind).keys()


def _child(parent: Any, step: int | str) -> Any:
    """Return the type below ``parent``, or None where types end."""
    if field := _fields(parent).get(str(step)):
        return _part(field.metadata) or _bare(field.annotation)
    if get_origin(parent) in (tuple, list):
        return _bare(get_args(parent)[0])
    if get_origin(parent) is dict:
        return _bare(get_args(parent)[1])
    return None


def _bare(annotation: Any) -> Any:
    """Return the annotation without Annotated and without ``| None``; of one that holds parts, their ``PartOf``."""
    if hasattr(annotation, "__metadata__"):
        return _part(annotation.__metadata__) or _bare(annotation.__origin__)
    members = [member for member in _members(annotation) if member is not type(None)]
    return _bare(members[0]) if len(members) == 1 else annotation


def _part(notes: Iterable[Any]) -> PartOf | None:
    return next((note for note in notes if isinstance(note, PartOf)), None)


def _members(annotation: Any) -> tuple[Any, ...]:
    is_union = get_origin(annotation) is Union or type(annotation).__name__ == "UnionType"
    return get_args(annotation) if is_union else ()


def _choices(union: Any) -> Iterator[tuple[str, Any]]:
    """Yield (tag, model) of a union that is told apart by ``kind``."""
    if isinstance(union, PartOf):
        yield from union.models().items()
    for member in map(_bare, _members(union)):
        kind = _fields(member).get("kind")
        if kind is not None and get_origin(kind.annotation) is Literal:
            yield from ((tag, member) for tag in get_args(kind.annotation))


def _is_tag(union: Any, step: int | str) -> bool:
    return any(step == tag for tag, _ in _choices(union))


def _choice(union: Any, step: int | str) -> Any:
    return dict(_choices(union))[str(step)]
