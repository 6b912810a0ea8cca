"""Proofs for every H by conditions on a scheme's coefficients, evaluated exactly.

The order is the largest r for which all conditions up to h^r hold. Where the conditions on area
hold, det J ≡ 1. They suffice; so where one does not, nothing follows for det J.
"""

from collections.abc import Callable, Sequence

from verify.proof.every_proof import EveryProof
from verify.prose import Formula, Number, Prose, count, prose
from verify.schemes.conditions.condition import ByConditions, Condition, NearbyOrder
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict

_MORE = 2  # orders beyond the claimed one that are looked at


def prove_by_conditions(scheme: Scheme, every_h: ByConditions, least: int = 0) -> EveryProof:
    """The order of the map and whether det J ≡ 1, for every H that the scheme takes.

    `conditions` of the result has those up to the claimed order, and those on area. REFUTED where
    one of the former fails, with the first that does; UNDECIDED where one is not decided, or where
    det J is not; `order` (of ΔJ) is always None.
    """
    least = max(scheme.order, least)
    agreed, wrong = agreed_order(every_h, least)
    near = nearby_order(every_h, least)
    asked = tuple(c for c in every_h.order_conditions(scheme.order) if c.order)
    area = every_h.area_conditions()
    verdict, reason = _verdict(scheme, asked, area)
    said = prose(f"order {agreed}, {_count(every_h, agreed)}")
    if near is None or near.order <= agreed:
        near = None
    else:  # the digits of the coefficients leave residues: of a splitting, whose det J ≡ 1
        said = told_nearby(near)
        verdict = near.verdict if agreed < scheme.order else Verdict.PROVED
        reason = prose("det J ≡ 1, and ", said)
        agreed, wrong = near.order, near.wrong
        if agreed < scheme.order:
            verdict, reason = _verdict(scheme, [wrong] if wrong else [], area)
    return EveryProof(
        scheme.name,
        every_h.separable,
        verdict,
        reason,
        area_preserving=(bool(area) and all(condition.holds for condition in area)) or None,
        convergence_order=agreed,
        convergence_decided=wrong is not None and wrong.holds is False,
        checked=(said, *_no_further(wrong)),
        conditions=(*asked, *area),
        nearby=near,
    )


def nearby_order(every_h: object, least: int) -> NearbyOrder | None:
    """Of exact coefficients near printed ones, as far as `agreed_order`; None where none is."""
    nearby: Callable[[int], NearbyOrder | None] | None = getattr(every_h, "nearby", None)
    if nearby is None or not isinstance(every_h, ByConditions):
        return None
    return nearby(min(least + _MORE, every_h.most_order))


def told_nearby(near: NearbyOrder) -> Prose:
    """Of which coefficients the order is, and what the digits leave."""
    return prose(f"order {near.order} of exact coefficients near the printed ones: ", near.said)


def agreed_order(every_h: ByConditions, least: int) -> tuple[int, Condition | None]:
    """The order of the map, as far as two beyond `least`, and the condition that ends it."""
    most = min(least + _MORE, every_h.most_order)
    for order in range(1, most + 1):
        here = [c for c in every_h.order_conditions(order) if c.order == order]
        wrong = first_wrong(here)
        if wrong is not None:
            return order - 1, wrong
    return most, None


def _no_further(wrong: Condition | None) -> tuple[Prose, ...]:
    if wrong is None:
        return ()
    word = "does not hold" if wrong.holds is False else "is not decided"
    power = Formula(f"h^{wrong.order}")
    return (prose("no further: of ", power, ", ", shown(wrong), f" {word}"),)


def _count(every_h: ByConditions, order: int) -> str:
    found = every_h.order_conditions(order) if order else ()
    return f"{count(len(found), 'condition')} on the coefficients"


def _verdict(
    scheme: Scheme, asked: Sequence[Condition], area: Sequence[Condition]
) -> tuple[Verdict, Prose]:
    wrong = first_wrong(asked)
    if wrong is not None and wrong.holds is False:
        claimed, power = f"{scheme.name} claims order {scheme.order}", Formula(f"h^{wrong.order}")
        return Verdict.REFUTED, prose(claimed, "; of ", power, ", ", shown(wrong), " does not hold")
    if wrong is not None:
        return Verdict.UNDECIDED, prose("whether ", shown(wrong), " holds is not decided")
    of_area = first_wrong(area)
    if of_area is not None:
        return Verdict.UNDECIDED, prose(
            f"order {scheme.order} is proved; of what suffices for det J ≡ 1, ",
            shown(of_area),
            " does not hold, and by that alone det J is not decided",
        )
    return Verdict.PROVED, prose(
        f"det J ≡ 1, and order {scheme.order}: every condition on the coefficients holds exactly"
    )


def first_wrong(conditions: Sequence[Condition]) -> Condition | None:
    """The failing one of the lowest order; else, of those not decided, the one of the lowest."""
    ordered = sorted(conditions, key=lambda c: c.order)
    failing = (c for c in ordered if c.holds is False)
    return next(failing, next((c for c in ordered if c.holds is None), None))


def shown(condition: Condition) -> Prose:
    """The condition with its residue."""
    residue = Number(condition.residue)
    return prose(Formula(condition.name), " (residue ", residue, ")")
