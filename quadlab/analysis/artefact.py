"""Tables and figures of the papers, what they claim, and what became of it here."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum


class Verdict(StrEnum):
    """Whether a claim holds here."""

    REPRODUCED = "reproduced"
    PARTLY = "partly"
    NOT = "not reproduced"
    NEW = "new"
    """No paper says anything of it."""


@dataclass(frozen=True)
class Claim:
    """One statement of a paper, beside what was measured.

    Attributes:
        text: what is claimed, with its unit.
        paper: the paper's value, in words where it gives none.
        ours: the measured value, with interval or number of trials.
        verdict: whether it holds.
        why: where it does not hold, or holds otherwise: the reason as far as it is known.
    """

    text: str
    paper: str
    ours: str
    verdict: Verdict
    why: str = ""


@dataclass(frozen=True)
class Artefact:
    """A table or figure.

    Attributes:
        identifier: short, e.g. "G-F6".
        source: e.g. "Gehring 2017, Fig. 6".
        title: what it shows.
        studies: from which it is drawn.
        caption: what is drawn, of which trial, and what lines and colours mean.
    """

    identifier: str
    source: str
    title: str
    studies: tuple[str, ...]
    caption: str


def overall(claims: Sequence[Claim]) -> Verdict:
    """Return the verdict on all claims of an artefact together; those of which no paper speaks do not count."""
    verdicts = {claim.verdict for claim in claims} or {Verdict.NEW}
    if len(verdicts) > 1:
        verdicts.discard(Verdict.NEW)
    return verdicts.pop() if len(verdicts) == 1 else Verdict.PARTLY


def verdict(*, holds: bool, partly: bool = False) -> Verdict:
    """Return the verdict of a comparison."""
    if holds:
        return Verdict.REPRODUCED
    return Verdict.PARTLY if partly else Verdict.NOT
