"""Readings of one statement: the claims of a file that share its texts, and their checks.

    [[claim]]
    id = "eq-9"
    statement = "…"                     # what the paper prints, with its source and section
    reading = "each component alone"    # in which sense; may be left out
    …

    [[claim]]
    id = "eq-9-in-the-plane"
    reading_of = "eq-9"                 # the same statement, whose texts it has, read otherwise
    reading = "both components together, in one norm"
    standing = "fair"                   # this is understood; or "strict", "misprint", "ours"
    …

See `verify.scenes.results.statement` for what the standings mean and when a statement is refuted.
A file in which no claim has one of these keys counts claims alone, and no statements.
"""

from collections.abc import Sequence

from verify.claims.claim import Claim
from verify.errors import NOT_GIVEN, InputError

_KEYS = {"reading_of", "reading", "standing"}


def settle_reading(claims: Sequence[Claim], index: int) -> Claim:
    """Return the claim at this place with its statement's id and texts, if these are counted.

    Raises InputError, whose name is the key, if its keys contradict each other or its statement.
    """
    claim = claims[index]
    if not any(_KEYS & each.model_fields_set for each in claims):
        return claim
    if claim.standing == "ours":
        if claim.reading_of:
            problem = "a claim of ours is no reading of a paper's statement"
            raise InputError("reading_of", claim.reading_of, problem)
        return claim
    if claim.reading_of:
        return _settle_other_reading(claims, index)
    # A statement that is only read strictly, or as a misprint, would count as none of the paper's.
    fair = [c for c in claims if claim.id in (c.id, c.reading_of) and c.standing == "fair"]
    if not fair:
        problem = "no reading of this statement is fair, so that it is none of the paper"
        raise InputError("standing", claim.standing, problem)
    return claim.model_copy(update={"reading_of": claim.id})


def _settle_other_reading(claims: Sequence[Claim], index: int) -> Claim:
    claim = claims[index]
    first = next((c for c in claims[:index] if c.id == claim.reading_of), None)
    if first is None:
        raise InputError("reading_of", claim.reading_of, "no claim before this one has this id")
    if first.standing == "ours" or first.reading_of not in ("", first.id):
        what = "is ours" if first.standing == "ours" else f"is a reading of {first.reading_of}"
        raise InputError("reading_of", claim.reading_of, f"{what}; name a statement's first claim")
    if claim.statement:
        raise InputError("statement", claim.statement, f"is that of {first.id}; say how it is read")
    if not claim.reading:
        raise InputError("reading", NOT_GIVEN, f"is missing: how {first.id} is read here")
    texts = {key: getattr(claim, key) or getattr(first, key) for key in ("source", "section")}
    return claim.model_copy(update={"statement": first.statement, **texts})
