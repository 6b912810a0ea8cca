"""Whose fault is it? One run of one scheme, judged.

Four solutions are held against one another: the exact one; the scheme's in high precision, which is
the scheme's own doing; its in 53 bits with no end of exponents, which adds float64's rounding; and
its in float64, which adds float64's range. What the first of them does that the one before did not
is to blame:

- the exact solution leaves every bound: `escapes`;
- the scheme leaves the exact orbit's bounds in high precision: `unstable: scheme`;
- float64 leaves them, or parts from the scheme in high precision, and so do 53 bits with any
  exponent: `unstable: arithmetic`;
- float64 alone does: `overflow` or `underflow`.

High precision is believed where twice as many digits say the same. What is bounded is `stable`, or
`drifts` (see `verify.studies.stability.energy_drift`). What bounds are, and when runs are apart, is
told in `verify.studies.stability.run_motion`.

In n degrees of freedom the motion may be sensitive, chaotic or near an unstable orbit, where
float64 parts from the scheme in high precision, and then no scheme is to blame, and no arithmetic:

- the exact motion parts from its neighbours exponentially: `sensitive`;
- it does not, and the scheme's own map does, in high precision: `unstable: scheme`;
- neither does: `unstable: arithmetic`;
- where the time does not tell: `undecided`.

A run that leaves its bounds in high precision is `unstable: scheme`; of a sensitive motion only
where it has lost its energy before: one that keeps it, and leaves, is `sensitive`.
"""

from dataclasses import dataclass
from fractions import Fraction
from itertools import chain

from verify.arithmetic.exact import fraction
from verify.arithmetic.systems import mpfr
from verify.prose import Number, Prose, prose, read_prose
from verify.scenes.results.stability import Kind
from verify.schemes import get
from verify.studies.stability.energy_drift import drift_of, too_short
from verify.studies.stability.exact_motion import ExactMotion
from verify.studies.stability.rounded_start import describe_rounded_start
from verify.studies.stability.run_motion import RunMotion, float64
from verify.studies.stability.trail import Trail, first_apart, first_step, follow, follow_precisely

_MOST_DIGITS = 400
_FLOAT_BITS = 53
_NEXT = Fraction(1, 10**14)
_FEWER_BITS = 45
_RANGE_STEPS = 20_000  # that are looked at for what float64's range does to them
_SMALL = Fraction(1, 10**75)  # the square of a square of what is smaller vanishes in float64
_LOST = Fraction(1, 2**20)  # of its own size: a component of which the range has taken so much
_KEPT = 1  # energy scales: what has not lost more has kept its energy


@dataclass(frozen=True)
class Judgement:
    """A verdict with its evidence; see `StabilityResult`."""

    kind: Kind
    detail: Prose
    step: int | None = None
    rate: Fraction | None = None
    energy_error: Fraction | None = None


def judge(motion: RunMotion) -> Judgement:
    """The verdict on one run."""
    orbit = motion.orbit
    if orbit.kind == "escapes":
        return Judgement("escapes", prose("the exact solution ", orbit.summary))
    stays = orbit.kind != "not followed" and motion.stays(motion.precise)
    if not stays and orbit.kind in ("unknown", "not followed"):
        unknown = "the exact solution, to be held against, is not known: "
        return Judgement("undecided", prose(unknown, orbit.summary))
    if not stays:
        return _leaves(motion)
    together = motion.together(motion.as_far, motion.precise)
    if isinstance(orbit, ExactMotion):
        return _bounded(motion) if together else _by_neighbours(motion, orbit)
    return _within_range(motion) if together else _by_digits(motion)


def _leaves(motion: RunMotion) -> Judgement:
    digits = 2 * motion.digits
    again = follow_precisely(motion.run, digits)
    step = first_step(again, motion.beyond)
    if step is None:
        told = prose(f"{motion.digits} and {digits} digits differ in whether the orbit stays")
        return Judgement("undecided", told)
    where = f"at step {step}, in {motion.digits} and in {digits} digits"
    if not isinstance(motion.orbit, ExactMotion):
        return Judgement("unstable: scheme", _end_words(motion, again, step, where), step=step)
    told = prose(f"the scheme leaves the bounds {where}")
    errors = motion.energy_errors(again)[: sum(x.step < step for x in again.points)]
    worst = fraction(max((abs(x) for x in errors if x is not None), default=0))
    if not motion.orbit.is_sensitive or worst > _KEPT:
        return Judgement("unstable: scheme", told, step=step)
    told += prose(", its energy kept; the exact solution ", motion.orbit.summary)
    return Judgement("sensitive", told, step=step, energy_error=worst)


def _end_words(motion: RunMotion, again: Trail, step: int, where: str) -> Prose:
    """How the scheme ends, and float64."""
    solved = get(motion.run.scheme).step_map(motion.run.hamiltonian).implicit
    unsolved = solved and not again.finished and step == again.done + 1
    does = "finds no solution of its equations" if unsolved else "leaves the bounds"
    told = prose(f"the scheme {does} {where}")
    if not motion.float64.finished:
        ends = "goes no further" if solved else "is out of its range"
        told += f"; float64 {ends} from step {motion.float64.done + 1} on"
    return told


def _parting(motion: RunMotion, precise: Trail, where: str) -> tuple[Prose, int | None]:
    """That float64 parts from the scheme in high precision, and the step."""
    here = motion.as_far
    step = first_apart(here, precise, motion.apart)
    at = f"at step {step}" if step is not None else f"before step {here.done + 1}"
    return prose(f"float64 parts {at} from the same scheme in {where} digits"), step


def _by_neighbours(motion: RunMotion, exact: ExactMotion) -> Judgement:
    """float64 is elsewhere than the scheme in high precision: so may exact neighbours be."""
    told, step = _parting(motion, motion.precise, str(motion.digits))
    kind: Kind = "unstable: arithmetic"
    if exact.is_sensitive is None:
        kind = "undecided"
    elif exact.is_sensitive:
        kind = "sensitive"
    elif motion.sensitivity.exponential:
        kind, rate = "unstable: scheme", f"{motion.sensitivity.exponent:.2g}"
        told += read_prose(f"; so do neighbours of its own orbit (`{rate}` in a unit of time)")
    told += prose("; the exact solution ", exact.summary)
    return Judgement(kind, told, step=step, energy_error=motion.worst(motion.precise))


def _by_digits(motion: RunMotion) -> Judgement:
    """The scheme in high precision stays; float64 does not, or is elsewhere."""
    here, confirmed = motion.as_far, _confirmed(motion)
    if confirmed is None:
        told = prose(f"up to {_MOST_DIGITS} digits no two precisions give the same orbit")
        return Judgement("undecided", told)
    digits, precise = confirmed
    which = f"{digits // 2} and in {digits}"
    if not motion.stays(precise):  # fewer digits did, by rounding
        step = first_step(precise, motion.beyond)
        told = prose(f"the scheme leaves the bounds, in {which} digits")
        return Judgement("unstable: scheme", told, step=step)
    if _range_alone(motion):
        return _out_of_range(motion, here)
    told, step = _parting(motion, precise, which)
    told += describe_rounded_start(motion.run)
    if motion.orbit.kind == "driven":
        told += _sensitive(motion, digits, precise)
    return Judgement("unstable: arithmetic", told, step=step or here.done + 1)


def _sensitive(motion: RunMotion, digits: int, precise: Trail) -> Prose:
    """Whether a neighbour parts from the run as well, without rounding: as driven ones may be
    chaotic."""
    p, q = motion.run.state
    state = p, q + _NEXT * (motion.orbit.reach[1] or 1)
    near = follow_precisely(motion.run.onwards(state, 0, precise.steps), digits)
    step = first_apart(near, precise, motion.apart)
    if step is None:
        return Prose()
    return prose(
        "; so does, without rounding, what starts 10⁻¹⁴ of the reach away, at step "
        f"{step}: the motion is sensitive there"
    )


def _confirmed(motion: RunMotion) -> tuple[int, Trail] | None:
    """The digits with which the run in high precision comes out the same again, and that run."""
    digits, last = motion.digits, motion.precise
    run = last.run
    while digits <= _MOST_DIGITS:
        digits *= 2
        again = follow_precisely(run, digits)
        if again.steps == last.steps and motion.together(again, last):
            return digits, again
        last = again
    return None


def _range_alone(motion: RunMotion) -> bool:
    """Whether any exponent does as high precision does, where float64 does not.

    In 53 bits and in fewer: where rounding parts runs, 53 bits may keep together by chance.
    """
    steps = min(motion.precise.steps, _RANGE_STEPS, motion.as_far.done + 1)
    run = motion.run.shortened(steps)
    precise = follow(run, motion.precise.arithmetic)
    if motion.together(follow(run, float64()), precise):
        return False
    wide = (follow(run, mpfr.at_bits(bits)) for bits in (_FLOAT_BITS, _FEWER_BITS))
    return all(motion.together(run, precise) for run in wide)


def _out_of_range(motion: RunMotion, here: Trail) -> Judgement:
    if here.finished:
        told = _vanished(motion) or prose("numbers vanish in float64 that wider exponents keep")
        return Judgement("underflow", told)
    told = prose(
        "a number is beyond float64's range; with 53 bits and wider exponents the run stays within "
        "its bounds"
    )
    return Judgement("overflow", told, step=here.done + 1)


def _vanished(motion: RunMotion) -> Prose:
    """What underflow has taken of a bounded run; empty where that is nothing.

    p or q as a whole, either of which may be small beside the other one.
    """
    seen = (abs(x) for x in (*chain(*motion.float64.columns), *motion.orbit.reach) if x)
    if min(seen, default=_SMALL) >= _SMALL:
        return Prose()
    run = motion.run.shortened(min(motion.run.steps, _RANGE_STEPS))
    wide, own = follow(run, mpfr.at_bits(_FLOAT_BITS)), follow(run, float64())
    for k, name in ((1, "q"), (0, "p")):
        true, kept = ([point.state[k] for point in trail.points] for trail in (wide, own))
        size = max(map(abs, true))
        gap = max(abs(x - y) for x, y in zip(true, kept, strict=False))
        if gap > _LOST * size:
            share = "all" if not any(kept) else Number(f"{float(gap / size):.1e}")
            rest = f" of {name} vanishes in float64; 53 bits with wider exponents keep it"
            return prose(share, rest)
    return Prose()


def _within_range(motion: RunMotion) -> Judgement:
    """float64 is where the scheme in high precision is, as far as that was followed."""
    if not motion.stays(motion.float64):
        held = f"the {motion.precise.steps} steps of the run it is held to"
        return Judgement("undecided", prose(f"float64 leaves its bounds beyond {held}"))
    lost = _vanished(motion)
    if lost:
        return Judgement("underflow", lost, energy_error=motion.worst(motion.float64))
    return _bounded(motion)


def _bounded(motion: RunMotion) -> Judgement:
    rate = drift_of(motion)
    told = _bounded_words(motion, drifts=rate is not None)
    kind: Kind = "stable" if rate is None else "drifts"
    return Judgement(kind, told, rate=rate, energy_error=motion.worst(motion.precise))


def _bounded_words(motion: RunMotion, drifts: bool) -> Prose:
    orbit, steps, precisely = motion.orbit, motion.run.steps, motion.precise.steps
    told = prose(f"bounded over all {steps} steps")
    if orbit.has_neighbours:
        if precisely < steps:
            told = prose(f"bounded over the {precisely} steps that were done in high precision")
        return told + prose("; the exact solution ", orbit.summary)
    if precisely < steps:
        told += f", of which {precisely} were done in high precision too"
    if orbit.kind == "driven":
        told += "; its energy changes with the drive, and is not looked at for a drift"
    if not drifts and too_short(motion):
        told += "; it goes round too few times to tell a drift of its energy from a swing"
    return told
