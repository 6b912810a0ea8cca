"""Proofs for every H by conditions on a scheme's coefficients, evaluated exactly.

The order is the largest r for which all conditions up to h^r hold. If the conditions on area hold,
det J ≡ 1. They are sufficient only: if one fails, nothing follows for det J.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from verify.proof.proof_for_every_h import ProofForEveryH
from verify.prose import Formula, Number, Prose, count, prose
from verify.schemes.conditions.condition import ByConditions, Condition, NearbyOrder
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict

_EXTRA_ORDERS = 2  # orders examined beyond the claimed one


def prove_by_conditions(scheme: Scheme, every_h: ByConditions, least: int = 0) -> ProofForEveryH:
    """Prove the order of the map, and det J ≡ 1, for every H that the scheme takes.

    `conditions` of the result are those up to the claimed order, then those on area. The verdict is
    REFUTED if one up to the claimed order fails, and the reason names the first; UNDECIDED if one
    of them, or det J, is not decided. If the coefficients are printed decimals, the verdict is that
    on exact coefficients near them. `order` (of ΔJ) is always None.
    """
    least = max(scheme.order, least)
    agreed, wrong = agreed_order(every_h, least)
    near = nearby_order(every_h, least)
    claimed = tuple(c for c in every_h.order_conditions(scheme.order) if c.order)
    # The conditions on area are sufficient, not necessary: a failing one proves nothing.
    area = every_h.area_conditions()
    verdict, reason = _verdict(scheme, claimed, area)
    summary = prose(f"order {agreed}, {_count(every_h, agreed)}")
    if near is None or near.order <= agreed:
        near = None
    else:  # only splittings have a `nearby`, and these have det J ≡ 1
        summary = describe_nearby(near)
        verdict = near.verdict if agreed < scheme.order else Verdict.PROVED
        reason = prose("det J ≡ 1, and ", summary)
        agreed, wrong = near.order, near.wrong
        if agreed < scheme.order:
            verdict, reason = _verdict(scheme, [wrong] if wrong else [], area)
    return ProofForEveryH(
        scheme.name,
        every_h.separable,
        verdict,
        reason,
        area_preserving=(bool(area) and all(condition.holds for condition in area)) or None,
        convergence_order=agreed,
        convergence_decided=wrong is not None and wrong.holds is False,
        checked=(summary, *_no_further(wrong)),
        conditions=(*claimed, *area),
        nearby=near,
    )


def nearby_order(every_h: object, least: int) -> NearbyOrder | None:
    """Return the order of exact coefficients near the printed ones, or None if there are none.

    Orders are examined as far as `agreed_order` does.
    """
    nearby: Callable[[int], NearbyOrder | None] | None = getattr(every_h, "nearby", None)
    if nearby is None or not isinstance(every_h, ByConditions):
        return None
    return nearby(min(least + _EXTRA_ORDERS, every_h.most_order))


def describe_nearby(near: NearbyOrder) -> Prose:
    """State the order of exact coefficients near the printed ones, and how near they are."""
    return prose(
        f"order {near.order} of exact coefficients near the printed ones: ", near.explanation
    )


class AgreedOrder(NamedTuple):
    """The order of a map, and the condition that ends it; None if none was reached."""

    order: int
    end: Condition | None


def agreed_order(every_h: ByConditions, least: int) -> AgreedOrder:
    """Return the order of the map, at most `least` + 2, and the condition that ends it."""
    most = min(least + _EXTRA_ORDERS, every_h.most_order)
    for order in range(1, most + 1):
        conditions = [c for c in every_h.order_conditions(order) if c.order == order]
        wrong = first_wrong(conditions)
        if wrong is not None:
            return AgreedOrder(order - 1, wrong)
    return AgreedOrder(most, None)


def _no_further(wrong: Condition | None) -> tuple[Prose, ...]:
    if wrong is None:
        return ()
    word = "does not hold" if wrong.holds is False else "is not decided"
    power = Formula(f"h^{wrong.order}")
    return (prose("no further: of ", power, ", ", format_condition(wrong), f" {word}"),)


def _count(every_h: ByConditions, order: int) -> str:
    conditions = every_h.order_conditions(order) if order else ()
    return f"{count(len(conditions), 'condition')} on the coefficients"


def _verdict(
    scheme: Scheme, claimed: Sequence[Condition], area: Sequence[Condition]
) -> tuple[Verdict, Prose]:
    wrong = first_wrong(claimed)
    if wrong is not None and wrong.holds is False:
        claim, power = f"{scheme.name} claims order {scheme.order}", Formula(f"h^{wrong.order}")
        return Verdict.REFUTED, prose(
            claim, "; of ", power, ", ", format_condition(wrong), " does not hold"
        )
    if wrong is not None:
        return Verdict.UNDECIDED, prose(
            "whether ", format_condition(wrong), " holds is not decided"
        )
    of_area = first_wrong(area)
    if of_area is not None:
        return Verdict.UNDECIDED, prose(
            f"order {scheme.order} is proved; of what suffices for det J ≡ 1, ",
            format_condition(of_area),
            " does not hold, and by that alone det J is not decided",
        )
    return Verdict.PROVED, prose(
        f"det J ≡ 1, and order {scheme.order}: every condition on the coefficients holds exactly"
    )


def first_wrong(conditions: Sequence[Condition]) -> Condition | None:
    """Return the failing condition of the lowest order, else the undecided one of the lowest."""
    # A failing condition comes before an undecided one of lower order: only a failing one refutes.
    ordered = sorted(conditions, key=lambda c: c.order)
    failing = (c for c in ordered if c.holds is False)
    return next(failing, next((c for c in ordered if c.holds is None), None))


def format_condition(condition: Condition) -> Prose:
    """Format the condition with its residue."""
    residue = Number(condition.residue)
    return prose(Formula(condition.name), " (residue ", residue, ")")
