"""Whether any map is symplectic: proved with symbols, else measured at points.

Nothing is said against a map by one means alone: what algebra refutes is evaluated at its witness
with dual numbers as well, and what a probe refutes is far beyond the probe's own error.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from verify.algebra.embedding import embed
from verify.algebra.limits import checked
from verify.algebra.ring import Poly, Ring
from verify.integrators.maps.probes import DualProbe, FloatProbe, Probe, Reading
from verify.integrators.maps.user_map import CallableMap, UserMap
from verify.integrators.step import StepError, lifted, why, within
from verify.integrators.tracing.domain import domain_of
from verify.integrators.tracing.functions import copied
from verify.integrators.tracing.readings_of_floats import readings
from verify.integrators.tracing.trace import Tape, expressions, in_order, sizes
from verify.proof.symplectic import closed_form
from verify.proof.symplectic.two_form import TwoForm
from verify.prose import Prose, prose, read_prose
from verify.verdict import Verdict

_SECONDS = 30.0  # for a proof
_MOST_WRITTEN = 4000  # operations of the map, written out, of which a proof is tried
_MOST_TERMS = 2000
_REFUTES = 1000.0  # times its noise that an entry of S is where a probe refutes
_HOLDS = 10.0  # and at most where nothing is seen
_BLIND = 1e-3  # noise beside entries of Ω, which are 1, with which a probe sees nothing
_AGREES = 1e-9  # of what is traced with what the function returns, in parts of their size
_OF_DIGITS = 1e-9  # what is smaller may come from coefficients that were written with few digits
_PARTS = ("1/3", "-1/2", "3/7", "2/5", "-3/8", "5/9", "-2/7", "4/11", "1/6", "-5/12", "3/10")
_POINTS = 6


class NotAFunctionError(StepError):
    """It returned one thing and then another."""


Called = dict[tuple[Fraction, ...], list[float]]  # what it returns at points


@dataclass(frozen=True)
class MapFinding:
    """`verdict` with its `reason`; `how`: "proof", "duals", "floats", or "calls" where the function
    was only called.

    `symplectic`: whether S ≡ 0, `area_preserving`: whether det J ≡ 1; None where that is not known.
    `entry`: the one of S that is not 0, with its `value` at `counterexample`, z by the names of the
    coordinates. `largest`: the largest entry that was measured, and `probe_error`: the error that
    it may have.
    """

    verdict: Verdict
    reason: Prose
    how: str
    degrees: int
    symplectic: bool | None = None
    area_preserving: bool | None = None
    entry: str = ""
    counterexample: dict[str, Fraction] | None = None
    value: str = ""
    largest: float | None = None
    probe_error: float | None = None
    domain: tuple[str, ...] = ()
    notes: tuple[Prose, ...] = ()

    def __repr__(self) -> str:
        return f"MapFinding({self.verdict}: {self.reason})"


def check_map(own: UserMap, start: Sequence[Fraction] | None = None) -> MapFinding:
    """Runs the user's code. `start`: a point z to look at beside others."""
    points = [tuple(start)] if start is not None else []
    points += points_of(len(own.names))
    try:
        called = called_at(FloatProbe(own), points)
    except Exception as error:  # the user's code may raise anything
        return MapFinding(Verdict.UNDECIDED, prose(why(error)), "calls", own.degrees)
    notes = list[Prose]()
    for examine in (_proved, _by_duals, _by_floats):
        try:
            found = examine(own, points, called)
            return replace(found, notes=(*notes, *found.notes))
        except Exception as error:  # as above
            notes.append(prose(f"{_MEANS[examine]}: ", why(error)))
    neither = prose("it can be neither traced nor measured")
    return MapFinding(Verdict.UNDECIDED, neither, "calls", own.degrees, notes=tuple(notes))


def called_at(floats: FloatProbe, points: Sequence[tuple[Fraction, ...]]) -> Called:
    """What it returns at points where it is defined, each time the same."""
    found, lost = Called(), list[Exception]()
    for point in points:
        try:
            found[point] = floats.value(point)
        except Exception as error:  # the user's code may raise anything
            lost.append(error)
    if not found:
        raise lost[0]
    if any(floats.value(point) != first for point, first in found.items()):
        raise NotAFunctionError("it returns another result when it is called again")
    return found


def points_of(size: int) -> list[tuple[Fraction, ...]]:
    """Points with small coordinates, all of them different."""
    parts = [Fraction(x) for x in _PARTS]
    return [
        tuple(parts[(k * (2 * i + 1) + i) % len(parts)] / (1 + k % 3) for k in range(size))
        for i in range(_POINTS)
    ]


# -- proved ---------------------------------------------------------------------------------------


def _proved(own: UserMap, points: Sequence[tuple[Fraction, ...]], called: Called) -> MapFinding:
    with within(_SECONDS, "its proof takes too long"):
        tape, ring, closed = _traced(own)
        duals = DualProbe(own)
        must_agree(duals, called)
        form = closed_form.defect(ring, own.names, closed)
        decision, place = form.decide()
        volume = closed_form.preserves_volume(ring, own.names, closed)
    where = domain_of(tape)
    base = MapFinding(
        Verdict.UNDECIDED, prose("whether S vanishes is not decided"), "proof", own.degrees,
        domain=where.texts, notes=(prose("traced with symbols"), *readings(tape)),
    )  # fmt: skip
    if decision.zero is True:
        said = prose("S is the zero form: the map is symplectic")
        reason = prose(said, ", where ", where.prose) if where else said
        return replace(
            base, verdict=Verdict.PROVED, reason=reason, symplectic=True, area_preserving=True
        )
    if decision.zero is None or place is None:
        return base
    if tape.rounded:
        told = measured(own, duals, points)
        return replace(told, notes=(*base.notes, *told.notes))
    return _refuted(base, duals, form, volume, decision.witness, place, decision.enclosure)


def _refuted(
    base: MapFinding, duals: DualProbe, form: TwoForm, volume: bool | None,
    witness: dict[str, Fraction], place: tuple[int, int], enclosure: str,
) -> MapFinding:  # fmt: skip
    """By algebra, and by dual numbers at its witness."""
    names = form.names
    z = {name: witness.get(name, Fraction(1, 3)) for name in names}
    reading, entry = duals.at(tuple(z.values())), form.called(place)
    found = abs(reading.entries[place])
    if found <= _REFUTES * reading.noise[place]:
        raise StepError("algebra and dual numbers do not agree on it")
    if found < _OF_DIGITS:
        said = (
            f"S is not 0: its entry {entry} is {found:.1e}, as coefficients of few digits leave it"
        )
        return replace(base, reason=prose(said), largest=found, probe_error=reading.noise[place])
    return replace(
        base,
        verdict=Verdict.REFUTED,
        reason=_against(entry, volume),
        symplectic=False,
        area_preserving=volume,
        entry=entry,
        counterexample=z,
        value=enclosure,
    )


def _against(entry: str, volume: bool | None) -> Prose:
    kept = "; det J ≡ 1 all the same" if volume else ""
    return prose(f"it is not symplectic: the entry {entry} of S is not 0{kept}")


def _traced(own: UserMap) -> tuple[Tape, Ring, list[Poly]]:
    """The map with symbols, as elements of a ring."""
    tape = Tape()
    symbols = [tape.symbol(name) for name in own.names]
    found = own.called(copied(own.function, tape), symbols, tape.rational)
    tape.check()
    roots = [x.node for x in lifted(symbols[0], found)]
    nodes = in_order(*roots)
    size = sizes(nodes)
    if sum(size[root.number] for root in roots) > _MOST_WRITTEN:
        raise StepError(f"written out it has more than {_MOST_WRITTEN} operations")
    made = expressions(nodes, {})
    exact = [checked(made[root.number], "map", "its closed form") for root in roots]
    ring, closed = embed(exact, own.names, _MOST_TERMS)
    return tape, ring, closed


def must_agree(duals: DualProbe, called: Called) -> None:
    """StepError where the copy that is traced is not the function that was called."""
    for point, theirs in called.items():
        ours = duals.value(point)
        size = 1 + max(map(abs, theirs))
        if max(abs(x - y) for x, y in zip(ours, theirs, strict=True)) > _AGREES * size:
            raise StepError("with numbers of ours it does something else than with floats")


# -- measured -------------------------------------------------------------------------------------


def _by_duals(own: UserMap, points: Sequence[tuple[Fraction, ...]], called: Called) -> MapFinding:
    duals = DualProbe(own)
    must_agree(duals, called)
    return measured(own, duals, points)


def _by_floats(own: UserMap, points: Sequence[tuple[Fraction, ...]], _: Called) -> MapFinding:
    return measured(own, FloatProbe(own), points)


_MEANS: dict[Callable[..., MapFinding], str] = {
    _proved: "no proof",
    _by_duals: "not measured with dual numbers",
    _by_floats: "not measured with floats",
}


def measured(own: CallableMap, probe: Probe, points: Sequence[tuple[Fraction, ...]]) -> MapFinding:
    """By the entries of S at the points, each against its noise.

    Points at which the probe sees nothing, as where the map wraps an angle, are left out and named.
    """
    found = list[Reading]()
    lost = StepError("it fails at all points")
    for point in points:
        try:
            found.append(probe.at(point))
        except Exception as error:  # the user's code may raise anything
            lost = StepError(str(why(error)))
    if len(found) < 2:
        raise lost
    blind = [r for r in found if max(r.noise.values()) > _BLIND and r.beyond <= _REFUTES]
    found = [r for r in found if r not in blind]
    if len(found) < 2 and not any(r.beyond > _REFUTES for r in found):
        return _unseen(own, probe, [*found, *blind])
    worst = max(found, key=lambda reading: reading.beyond)
    entry = f"d{own.names[worst.worst[0]]}∧d{own.names[worst.worst[1]]}"
    base = MapFinding(
        Verdict.UNDECIDED, prose(""), probe.how, len(own.names) // 2,
        largest=max(abs(x) for r in found for x in r.entries.values()),
        probe_error=max(x for r in found for x in r.noise.values()),
        area_preserving=_of_volume(found), entry=entry,
        notes=(_left_out(own.names, blind),) if blind else (),
    )  # fmt: skip
    what = f"at {len(found)} points"
    if worst.beyond > _REFUTES:
        return replace(
            base,
            verdict=Verdict.REFUTED,
            reason=_against(entry, None),
            symplectic=False,
            counterexample=dict(zip(own.names, worst.point, strict=True)),
            value=f"{worst.entries[worst.worst]:.6e} ± {worst.noise[worst.worst]:.1e}",
        )
    if worst.beyond <= _HOLDS:
        said = f"{what} no entry of S is seen to differ from 0, to {base.probe_error:.1e}"
        return replace(
            base, verdict=Verdict.MEASURED, reason=read_prose(said), symplectic=True, entry=""
        )
    said = (
        f"{what} S is up to {worst.beyond:.0f} times what the probe may be off, where it is "
        f"`{worst.entries[worst.worst]:.1e}` ± `{worst.noise[worst.worst]:.1e}`: neither shown nor "
        "refuted"
    )
    return replace(base, reason=read_prose(said))


def _unseen(own: CallableMap, probe: Probe, readings: Sequence[Reading]) -> MapFinding:
    """UNDECIDED, as its own error is too large nearly everywhere."""
    errors = [max(r.noise.values()) for r in readings]
    least, most = min(errors), max(errors)
    said = f"the probe sees nothing: its own error is `{least:.1e}` to `{most:.1e}` at the points"
    degrees = len(own.names) // 2
    return MapFinding(Verdict.UNDECIDED, read_prose(said), probe.how, degrees, probe_error=most)


def _left_out(names: Sequence[str], blind: Sequence[Reading]) -> Prose:
    """Which points, each with the probe's error there."""
    each = [
        ", ".join(f"{name} = `{x}`" for name, x in zip(names, r.point, strict=True))
        + f" (`{max(r.noise.values()):.1e}`)"
        for r in blind
    ]
    where = "; ".join(each)
    return read_prose(f"left out, as the probe's own error is not small against 1: {where}")


def _of_volume(found: Sequence[Reading]) -> bool | None:
    """Whether det J is 1 at all of the points."""
    beyond = [abs(r.volume) / r.volume_noise for r in found]
    if max(beyond) > _REFUTES:
        return False
    return True if max(beyond) <= _HOLDS else None
