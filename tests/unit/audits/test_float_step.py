"""Steps in floats: what is claimed is measured, and a library that fails refutes nothing."""

import io
import math
from collections.abc import Callable
from contextlib import redirect_stdout

from verify.audits.library_claims import claims_of
from verify.audits.methods.float_step import finding
from verify.audits.methods.integrator import FINE, FloatStep, Map, ReleasedIntegrator
from verify.verdict import Verdict

PENDULUM = "p**2/2 - cos(q)"


def verlet(p: float, q: float, h: float) -> tuple[float, float]:
    p -= h / 2 * math.sin(q)
    q += h * p
    return p - h / 2 * math.sin(q), q


def heun(p: float, q: float, h: float) -> tuple[float, float]:
    a, b = -math.sin(q), p
    c, d = -math.sin(q + h * b), p + h * a
    return p + h / 2 * (a + c), q + h / 2 * (b + d)


def broken(p: float, q: float, h: float) -> tuple[float, float]:
    raise RuntimeError("no such method")


def frozen(p: float, q: float, h: float) -> tuple[float, float]:
    return p, q


def judged(step: Map, order: int, area: bool | None = True) -> list[Verdict]:
    make: Callable[[], Map] = lambda: step  # noqa: E731 - a integrator makes its step
    integrator = ReleasedIntegrator(
        "mine", "by hand", "nowhere", FloatStep(PENDULUM, make), order, area
    )
    return [claim.verdict for claim in claims_of(integrator, "mine", "mine")]


def test_true_claims_are_measured() -> None:
    assert judged(verlet, 2) == [Verdict.MEASURED, Verdict.MEASURED]
    assert judged(heun, 2, None) == [Verdict.MEASURED]


def test_an_order_one_too_high_and_a_wrong_symplecticity_are_refuted() -> None:
    assert judged(verlet, 3) == [Verdict.REFUTED, Verdict.MEASURED]
    assert judged(heun, 2) == [Verdict.MEASURED, Verdict.REFUTED]


def test_what_cannot_be_driven_refutes_nothing() -> None:
    assert judged(broken, 2) == [Verdict.UNDECIDED, Verdict.UNDECIDED]

    def missing() -> Map:
        raise ModuleNotFoundError("No module named 'nothing'")

    found = finding(FloatStep(PENDULUM, missing))
    assert found.verdict is Verdict.UNDECIDED
    assert "nothing" in found.reason


def test_a_map_that_does_nothing_has_no_order() -> None:
    assert Verdict.MEASURED not in judged(frozen, 1)


def test_a_power_that_is_seen_in_passing_only_is_not_known() -> None:
    def passing(p: float, q: float, h: float) -> tuple[float, float]:
        """The flow nearly, with an error like h³ from 1/2 to 3/4 alone."""
        x, y = p, q
        for _ in range(64):
            x, y = verlet(x, y, h / 64)
        return x + h**3 / (1 + (h / 0.62) ** 12), y

    found = finding(FloatStep(PENDULUM, lambda: passing, ladder=FINE[:14]))
    assert not found.order_decided


DRIVEN = "p**2/2 - cos(q) - q*cos(t)/2"


def driven(first: float, last: float) -> Map:
    """Störmer–Verlet, with these moments of its two kicks."""

    def kick(q: float, t: float, h: float) -> float:
        return h / 2 * (math.cos(t) / 2 - math.sin(q))

    def step(p: float, q: float, t: float, h: float) -> tuple[float, float]:
        p += kick(q, t + first * h, h)
        q += h * p
        return p + kick(q, t + last * h, h), q

    return step


def told(step: Map, order: int | None) -> tuple[str, Verdict, str]:
    method = FloatStep(DRIVEN, lambda: step)
    own = ReleasedIntegrator("mine", "by hand", "nowhere", method, order, reproduction=SCRIPT)
    (claim,) = claims_of(own, "mine", "mine")
    return claim.kind, claim.verdict, str(claim.evidence)


SCRIPT = """\
from math import cos, sin


def step(p, q, t, h):
    p += h / 2 * (cos(t) / 2 - sin(q))
    q += h * p
    return p + h / 2 * (cos(t) / 2 - sin(q)), q
"""


def test_an_order_is_held_against_a_force_that_depends_on_time() -> None:
    kind, verdict, _ = told(driven(0, 1), 2)
    assert (kind, verdict) == ("order", Verdict.MEASURED)
    kind, verdict, evidence = told(driven(0, 0), 2)
    assert (kind, verdict) == ("order", Verdict.REFUTED)
    assert "order is 1" in evidence
    assert "it is of order 2 as if the force were read at t in every stage" in evidence


def test_where_nothing_is_claimed_of_time_nothing_is_refuted() -> None:
    kind, verdict, evidence = told(driven(0, 0), None)
    assert (kind, verdict) == ("in time", Verdict.MEASURED)
    assert "its clock stands still" in evidence
    assert told(driven(0, 1), None)[1] is Verdict.MEASURED


def test_what_is_found_of_time_has_lines_that_show_it() -> None:
    printed = io.StringIO()
    method = FloatStep(DRIVEN, lambda: driven(0, 0))
    for order in (2, None):
        own = ReleasedIntegrator("mine", "by hand", "nowhere", method, order, reproduction=SCRIPT)
        (claim,) = claims_of(own, "mine", "mine")
        with redirect_stdout(printed):
            exec(claim.reproduction, {})  # noqa: S102 - it is what is tested
    slopes = [slope for line in printed.getvalue().splitlines() for _, slope in eval(line)]  # noqa: S307
    assert len(slopes) == 6
    assert all(1.8 < slope < 2.3 for slope in slopes)
