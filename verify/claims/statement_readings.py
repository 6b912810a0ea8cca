"""The claims of a file that are readings of one statement, or what can be claimed in its place.

Several claims may be readings of one statement, whose texts they share:

    [[claim]]
    id = "eq-9"
    statement = "…"                     # what the paper prints, with its source and section
    reading = "each component alone"    # in which sense; may be left out

    [[claim]]
    id = "eq-9-in-the-plane"
    reading_of = "eq-9"                 # the same statement, whose texts it has, read otherwise
    reading = "both components together, in one norm"
    standing = "fair"                   # this is understood; or "strict", "misprint", "ours"
    repaired = "…"                      # the statement as it would be right, read this way
    effect = "none"                     # of the repair on the paper; or "table", "conclusion"

A claim that is ours may be what can be claimed in place of a statement: `repairs = "eq-9"`. Its
verdict shows that the repair is right. See `verify.scenes.results.claim` for what the standings
mean and when a statement is refuted.
A file in which no claim has one of these keys counts claims alone, and no statements.
"""

from collections.abc import Sequence

from verify.claims.base_claim import KEYS_OF_READINGS, Claim
from verify.errors import NOT_GIVEN, InputError, unknown_name


def settle_reading(claims: Sequence[Claim], index: int) -> Claim:
    """Return the claim at this place with its statement's id and texts, if these are counted.

    Raises InputError, whose name is the key, if its keys contradict each other or its statement.
    """
    claim = claims[index]
    if all(other.model_fields_set.isdisjoint(KEYS_OF_READINGS) for other in claims):
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
    statement = next((c for c in claims[:index] if c.id == claim.reading_of), None)
    if statement is None:
        raise InputError("reading_of", claim.reading_of, "no claim before this one has this id")
    if statement.standing == "ours" or statement.reading_of not in ("", statement.id):
        problem = (
            "is ours" if statement.standing == "ours" else f"is a reading of {statement.reading_of}"
        )
        raise InputError(
            "reading_of", claim.reading_of, f"{problem}; name a statement's first claim"
        )
    if claim.statement:
        raise InputError(
            "statement", claim.statement, f"is that of {statement.id}; say how it is read"
        )
    if not claim.reading:
        raise InputError("reading", NOT_GIVEN, f"is missing: how {statement.id} is read here")
    texts = {key: getattr(claim, key) or getattr(statement, key) for key in ("source", "section")}
    return claim.model_copy(update={"statement": statement.statement, **texts})


def check_repair(claim: Claim, claims: Sequence[Claim]) -> None:
    """Raise InputError, whose name is the key, if the claim repairs no statement of the file.

    `claims`: all claims of the file, with their keys as they stand there.
    """
    statements = [c.id for c in claims if c.standing != "ours" and c.reading_of in ("", c.id)]
    if claim.repairs and claim.standing != "ours":
        raise InputError("repairs", claim.repairs, "is a key of claims that are ours")
    if claim.repairs and claim.repairs not in statements:
        raise unknown_name("repairs", claim.repairs, statements)
    if not claim.repairs and (not claim.reading_of or not claim.repaired):
        for key in ("repaired", "effect"):
            if value := getattr(claim, key):
                problem = "goes with `repairs`, or with `repaired` in a reading of a statement"
                raise InputError(key, value, problem)
