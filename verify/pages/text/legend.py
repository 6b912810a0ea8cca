"""The legend of a page: signs of verdicts, terms with their meanings, kinds of runs in words."""

import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from markupsafe import Markup

from verify import arithmetic as number_systems
from verify.pages.text.typography import join_and, whole
from verify.scenes.results.stability import KINDS, Kind
from verify.verdict import Verdict

# The sign of each verdict, beside its colour, and its meaning.
SIGNS = {
    Verdict.PROVED: ("✓", "exact algebra shows it"),
    Verdict.ENCLOSED: ("⊂", "a rigorous numeric enclosure shows it; its error bound is certain"),
    Verdict.MEASURED: ("≈", "numbers show it; their error bounds are estimates, not certificates"),
    Verdict.REFUTED: ("✗", "a counterexample, or the proof of the contrary, contradicts it"),
    Verdict.UNDECIDED: ("?", "neither shown nor contradicted by what was computed"),
}
_GLOSSARY = Path(__file__).parent.parent / "templates" / "glossary.html"
_GROUP = re.compile(r'<dl id="(.*?)">(.*?)</dl>', re.DOTALL)
_TERM = re.compile(r"<dt>(.*?)</dt>\s*<dd>(.*?)</dd>", re.DOTALL)


@cache
def terms_of(group: str) -> dict[str, Markup]:
    """Return the terms of a group in `templates/glossary.html`, with their meanings."""
    terms = _TERM.findall(dict(_GROUP.findall(_GLOSSARY.read_text(encoding="utf-8")))[group])
    return {term: Markup(" ".join(meaning.split())) for term, meaning in terms}  # noqa: S704


def terms_of_runs() -> dict[str, Markup]:
    """Return the kinds of error bounds, and the number systems, with their meanings."""
    systems = sorted(map(number_systems.about, number_systems.names()), key=lambda x: x.cost)
    sentences = (Markup("<code>{}</code>: {}.").format(x.name, x.about) for x in systems)
    return terms_of("runs") | {"Number systems": Markup(" ").join(sentences)}


# -- counts of judged runs in a sentence ----------------------------------------------------------

_ADJECTIVES: dict[Kind, str] = {
    "stable": "stable",
    "drifts": "drifting",
    "unstable: scheme": "unstable by the scheme",
    "unstable: arithmetic": "unstable by the arithmetic",
    "escapes": "escaping",
    "overflow": "overflowing",
    "underflow": "underflowing",
    "sensitive": "sensitive",
    "undecided": "undecided",
}


def counts_of(counts: Mapping[Kind, int]) -> str:
    """Return the counts of the kinds with adjectives, as the names of the kinds fit no sentence."""
    return join_and(
        f"{whole(counts[kind])} {_ADJECTIVES[kind]}" for kind in KINDS if counts.get(kind)
    )
