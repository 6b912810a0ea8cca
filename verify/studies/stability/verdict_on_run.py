"""The verdict on one run of one scheme: is it stable, and if not, what is to blame?

Four solutions are compared: the exact one; the scheme's in high precision, which shows the scheme
alone; the scheme's in 53 bits with unlimited exponents, which adds float64's rounding; and the
scheme's in float64, which adds float64's range. The first of them that misbehaves shows what is to
blame:

- the exact solution leaves every bound: `escapes`;
- the scheme leaves its bounds in high precision: `unstable: scheme`;
- float64 leaves them, or parts from the scheme in high precision, and so do 53 bits with any
  exponent: `unstable: arithmetic`;
- float64 alone does: `overflow` or `underflow`.

`verify.studies.stability.run_motion` defines the bounds, when two runs are apart, and when a
bounded run drifts: it is `drifts`, else `stable`. In the plane, if float64 parts from the scheme in
high precision, that is confirmed by twice as many digits.

In n degrees of freedom the motion may be sensitive: chaotic, or near an unstable orbit. If float64
parts from the scheme in high precision, neighbours show what is to blame:

- the exact motion parts from its neighbours exponentially: `sensitive`, nothing is to blame;
- it does not, and the scheme's own map does, in high precision: `unstable: scheme`;
- neither does: `unstable: arithmetic`;
- the time is too short to decide: `undecided`.

A run that leaves its bounds in high precision is `unstable: scheme`, but `sensitive` if the exact
motion is sensitive and the run has kept its energy until then.
"""

from dataclasses import dataclass
from fractions import Fraction
from itertools import chain

from verify.arithmetic.exact import fraction
from verify.arithmetic.systems import mpfr
from verify.prose import Number, Prose, prose, read_prose
from verify.scenes.results.stability import Kind
from verify.schemes import get
from verify.studies.stability.exact_motion import ExactMotion
from verify.studies.stability.rounded_start import describe_rounded_start
from verify.studies.stability.run_motion import RunMotion, find_drift, float64, is_too_short
from verify.studies.stability.trail import (
    RunTrail,
    find_first_apart,
    find_first_step,
    follow,
    follow_precisely,
)

_MOST_DIGITS = 400
_FLOAT_BITS = 53
_NEIGHBOUR_DISTANCE = Fraction(1, 10**14)  # relative to the reach
_FEWER_BITS = 45
_RANGE_STEPS = 20_000  # steps that are examined for effects of float64's range
_SMALL = Fraction(1, 10**75)  # the fourth power of a smaller number may vanish in float64
_LEAST_LOSS = Fraction(1, 2**20)  # by underflow, relative to the greatest |q| or |p|
_MAX_ENERGY_ERROR = 1  # energy scales; a run with no greater error has kept its energy


@dataclass(frozen=True)
class RunJudgement:
    """A verdict with its evidence; see `StabilityResult`."""

    kind: Kind
    detail: Prose
    step: int | None = None
    rate: Fraction | None = None
    energy_error: Fraction | None = None


def judge(motion: RunMotion) -> RunJudgement:
    """Return the verdict on one run."""
    orbit = motion.orbit
    if orbit.kind == "escapes":
        return RunJudgement("escapes", prose("the exact solution ", orbit.summary))
    # A run that stays is judged even if the exact orbit was followed for a part of the time only.
    stays = orbit.kind != "not followed" and motion.stays(motion.precise)
    if not stays and orbit.kind in ("unknown", "not followed"):
        unknown = "the exact solution, to be held against, is not known: "
        return RunJudgement("undecided", prose(unknown, orbit.summary))
    if not stays:
        return _judge_leaving(motion)
    together = motion.stay_together(motion.float64_as_far, motion.precise)
    if isinstance(orbit, ExactMotion):
        return _judge_bounded(motion) if together else _judge_by_neighbours(motion, orbit)
    # In the plane a run that parts is examined further: by more digits, and by wider exponents.
    return _judge_within_range(motion) if together else _judge_by_digits(motion)


def _judge_leaving(motion: RunMotion) -> RunJudgement:
    digits = 2 * motion.digits
    finer_trail = follow_precisely(motion.run, digits)
    step = find_first_step(finer_trail, motion.is_beyond)
    if step is None:
        detail = prose(f"{motion.digits} and {digits} digits differ in whether the orbit stays")
        return RunJudgement("undecided", detail)
    place_text = f"at step {step}, in {motion.digits} and in {digits} digits"
    if not isinstance(motion.orbit, ExactMotion):
        return RunJudgement(
            "unstable: scheme", _describe_end(motion, finer_trail, step, place_text), step=step
        )
    detail = prose(f"the scheme leaves the bounds {place_text}")
    errors = motion.energy_errors(finer_trail)[: sum(x.step < step for x in finer_trail.points)]
    worst = fraction(max((abs(x) for x in errors if x is not None), default=0))
    if not motion.orbit.is_sensitive or worst > _MAX_ENERGY_ERROR:
        return RunJudgement("unstable: scheme", detail, step=step)
    detail += prose(", its energy kept; the exact solution ", motion.orbit.summary)
    return RunJudgement("sensitive", detail, step=step, energy_error=worst)


def _describe_end(motion: RunMotion, finer_trail: RunTrail, step: int, place_text: str) -> Prose:
    """Describe how the scheme's run ends, and float64's."""
    solves_equations = get(motion.run.scheme).step_map(motion.run.hamiltonian).implicit
    # An implicit scheme may fail at the step after the last one done, as its equations then have no
    # solution, and not as the orbit leaves.
    lacks_solution = (
        solves_equations and not finer_trail.is_finished and step == finer_trail.done + 1
    )
    does = "finds no solution of its equations" if lacks_solution else "leaves the bounds"
    sentences = prose(f"the scheme {does} {place_text}")
    if not motion.float64.is_finished:
        ends = "goes no further" if solves_equations else "is out of its range"
        sentences += f"; float64 {ends} from step {motion.float64.done + 1} on"
    return sentences


def _describe_parting(
    motion: RunMotion, precise: RunTrail, digits_text: str
) -> tuple[Prose, int | None]:
    """Return the sentence that float64 parts from the scheme in high precision, and the step."""
    here = motion.float64_as_far
    step = find_first_apart(here, precise, motion.are_apart)
    when = f"at step {step}" if step is not None else f"before step {here.done + 1}"
    return prose(f"float64 parts {when} from the same scheme in {digits_text} digits"), step


def _judge_by_neighbours(motion: RunMotion, exact_motion: ExactMotion) -> RunJudgement:
    """Judge a run in which float64 and high precision part, by whose neighbours part too."""
    detail, step = _describe_parting(motion, motion.precise, str(motion.digits))
    kind: Kind = "unstable: arithmetic"
    if exact_motion.is_sensitive is None:
        kind = "undecided"
    elif exact_motion.is_sensitive:
        kind = "sensitive"
    # The exact motion parts from its neighbours slowly and the scheme's own map does not: the
    # sensitivity comes from the scheme.
    elif motion.sensitivity.exponential:
        kind, rate = "unstable: scheme", f"{motion.sensitivity.exponent:.2g}"
        detail += read_prose(f"; so do neighbours of its own orbit (`{rate}` in a unit of time)")
    detail += prose("; the exact solution ", exact_motion.summary)
    return RunJudgement(kind, detail, step=step, energy_error=motion.worst(motion.precise))


def _judge_by_digits(motion: RunMotion) -> RunJudgement:
    """Judge a run that stays in high precision, which float64 leaves or parts from."""
    here, confirmation = motion.float64_as_far, _confirm_run(motion)
    if confirmation is None:
        detail = prose(f"up to {_MOST_DIGITS} digits no two precisions give the same orbit")
        return RunJudgement("undecided", detail)
    digits, precise = confirmation
    digits_text = f"{digits // 2} and in {digits}"
    if not motion.stays(precise):  # fewer digits did, by rounding
        step = find_first_step(precise, motion.is_beyond)
        detail = prose(f"the scheme leaves the bounds, in {digits_text} digits")
        return RunJudgement("unstable: scheme", detail, step=step)
    if _is_range_to_blame(motion):
        return _judge_out_of_range(motion, here)
    detail, step = _describe_parting(motion, precise, digits_text)
    detail += describe_rounded_start(motion.run)
    if motion.orbit.kind == "driven":
        detail += _describe_sensitivity(motion, digits, precise)
    return RunJudgement("unstable: arithmetic", detail, step=step or here.done + 1)


def _describe_sensitivity(motion: RunMotion, digits: int, precise: RunTrail) -> Prose:
    """Describe the parting of a neighbour in high precision, which shows chaos; empty if none."""
    p, q = motion.run.state
    state = p, q + _NEIGHBOUR_DISTANCE * (motion.orbit.reach[1] or 1)
    neighbour = follow_precisely(motion.run.onwards(state, 0, precise.steps), digits)
    step = find_first_apart(neighbour, precise, motion.are_apart)
    if step is None:
        return Prose()
    return prose(
        "; so does, without rounding, what starts 10⁻¹⁴ of the reach away, at step "
        f"{step}: the motion is sensitive there"
    )


def _confirm_run(motion: RunMotion) -> tuple[int, RunTrail] | None:
    """Return the digits at which two runs in high precision agree, and the second of them."""
    digits, last = motion.digits, motion.precise
    run = last.run
    while digits <= _MOST_DIGITS:
        # Twice the digits, since a chaotic orbit loses them in proportion to the time.
        digits *= 2
        finer_trail = follow_precisely(run, digits)
        if finer_trail.steps == last.steps and motion.stay_together(finer_trail, last):
            return digits, finer_trail
        last = finer_trail
    return None


def _is_range_to_blame(motion: RunMotion) -> bool:
    """Return True if 53 and 45 bits with wide exponents agree with high precision, not float64."""
    steps = min(motion.precise.steps, _RANGE_STEPS, motion.float64_as_far.done + 1)
    run = motion.run.with_steps(steps)
    precise = follow(run, motion.precise.arithmetic)
    if motion.stay_together(follow(run, float64()), precise):
        return False
    # Agreement in 53 bits alone may be luck; 45 bits round differently, so that both agree only
    # where rounding does not matter.
    wide = (follow(run, mpfr.at_bits(bits)) for bits in (_FLOAT_BITS, _FEWER_BITS))
    return all(motion.stay_together(run, precise) for run in wide)


def _judge_out_of_range(motion: RunMotion, here: RunTrail) -> RunJudgement:
    if here.is_finished:
        detail = _describe_underflow(motion) or prose(
            "numbers vanish in float64 that wider exponents keep"
        )
        return RunJudgement("underflow", detail)
    detail = prose(
        "a number is beyond float64's range; with 53 bits and wider exponents the run stays within "
        "its bounds"
    )
    return RunJudgement("overflow", detail, step=here.done + 1)


def _describe_underflow(motion: RunMotion) -> Prose:
    """Describe the loss of a bounded run by underflow; empty if there is none to speak of.

    The loss of q and of p is relative to each of them, since one may be small beside the other.
    """
    sizes = (abs(x) for x in (*chain(*motion.float64.columns), *motion.orbit.reach) if x)
    # Nothing as small as this has occurred, so that no fourth power can have vanished.
    if min(sizes, default=_SMALL) >= _SMALL:
        return Prose()
    run = motion.run.with_steps(min(motion.run.steps, _RANGE_STEPS))
    wide, narrow = follow(run, mpfr.at_bits(_FLOAT_BITS)), follow(run, float64())
    for k, name in ((1, "q"), (0, "p")):
        true, remaining = ([point.state[k] for point in trail.points] for trail in (wide, narrow))
        size = max(map(abs, true))
        gap = max(abs(x - y) for x, y in zip(true, remaining, strict=False))
        if gap > _LEAST_LOSS * size:
            share = "all" if not any(remaining) else Number(f"{float(gap / size):.1e}")
            sentence_end = f" of {name} vanishes in float64; 53 bits with wider exponents keep it"
            return prose(share, sentence_end)
    return Prose()


def _judge_within_range(motion: RunMotion) -> RunJudgement:
    """Judge a run that agrees with high precision as far as that was followed."""
    if not motion.stays(motion.float64):
        bounds_end = f"the {motion.precise.steps} steps of the run it is held to"
        return RunJudgement("undecided", prose(f"float64 leaves its bounds beyond {bounds_end}"))
    lost = _describe_underflow(motion)
    if lost:
        return RunJudgement("underflow", lost, energy_error=motion.worst(motion.float64))
    return _judge_bounded(motion)


def _judge_bounded(motion: RunMotion) -> RunJudgement:
    rate = find_drift(motion)
    detail = _describe_bounded(motion, drifts=rate is not None)
    kind: Kind = "stable" if rate is None else "drifts"
    return RunJudgement(kind, detail, rate=rate, energy_error=motion.worst(motion.precise))


def _describe_bounded(motion: RunMotion, drifts: bool) -> Prose:
    orbit, steps, precisely = motion.orbit, motion.run.steps, motion.precise.steps
    detail = prose(f"bounded over all {steps} steps")
    if orbit.has_neighbours:
        if precisely < steps:
            detail = prose(f"bounded over the {precisely} steps that were done in high precision")
        return detail + prose("; the exact solution ", orbit.summary)
    if precisely < steps:
        detail += f", of which {precisely} were done in high precision too"
    if orbit.kind == "driven":
        detail += "; its energy changes with the drive, and is not looked at for a drift"
    if not drifts and is_too_short(motion):
        detail += "; it goes round too few times to tell a drift of its energy from a swing"
    return detail
