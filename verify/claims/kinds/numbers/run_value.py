"""A printed number of one run: its last state, an error of the energy or of any first integral.

`of` names what is printed: `q`, `p`, `q1`, …, of the state after the last step; `energy_error` and
`energy_error_max`, H − H₀ after it and the greatest |H − H₀| on the way; the same of a formula,
`integral_error: q1*p2 - q2*p1` and `integral_error_max: …`; or another observable of a run. Bars
take the size, `|energy_error|`. It rounds to what is `printed`, or lies below or above a bound.
"""

import re
from fractions import Fraction
from typing import Literal, Self

from pydantic import model_validator

from verify import observables
from verify.algebra.enclosure import enclose
from verify.algebra.formula import parse
from verify.arithmetic.arb import (
    Ball,
    ball,
    bounds,
    format_ball,
    is_representable,
    lg,
    rational_ball,
)
from verify.claims.base_claim import Findings
from verify.claims.quantities import (
    MORE_DIGITS,
    ROUNDING,
    PrintedDecimal,
    all_hold,
    rounds_to,
)
from verify.claims.run_claims import RunClaim
from verify.errors import NOT_GIVEN, InputError, unknown_name
from verify.hamiltonians.canonical_field import field_of
from verify.observables.observable import ENERGY
from verify.prose import Number, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.verdict import Verdict

_COORDINATE = re.compile(r"[pq]([1-9]\d{0,2})?", re.ASCII)
_PRECISION = 192


class RunValueClaim(RunClaim):
    """One printed number of the state or of an observable of one run."""

    one_run = True
    separate_runs = True
    kind: Literal["run_value"]
    of: str
    """The number: `q`, `p`, `energy_error`, `energy_error_max`, `integral_error: …`, …; its
    size in bars."""
    relative: bool = False
    """The error of the energy or an integral is in parts of its initial value."""
    printed: PrintedDecimal | None = None
    """The number as printed; one of this and the next three."""
    lg_printed: PrintedDecimal | None = None
    """Its logarithm to the base 10 as printed."""
    at_most: PrintedDecimal | None = None
    """The number is at most this."""
    at_least: PrintedDecimal | None = None
    """The number is at least this."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if len(self.printed_texts()) != 1:
            keys = "printed, lg_printed, at_most, at_least"
            raise InputError(keys, NOT_GIVEN, "give one of the four")
        observable = observables.find(self._name)
        if observable is None and not _COORDINATE.fullmatch(self._name):
            names = ("q", "p", *observables.by_name(), "integral_error: …", "integral_error_max: …")
            raise unknown_name("of", self._name, names)
        if self.relative and not (observable and observable.integral):
            raise InputError("relative", True, "is of the energy or of an integral")
        return self

    @property
    def _name(self) -> str:
        """The name of the number, without the bars of a size."""
        return self.of.strip().removeprefix("|").removesuffix("|").strip()

    @property
    def _is_size(self) -> bool:
        """True if the sign does not count: in bars, or where a logarithm is printed."""
        return self._name != self.of.strip() or self.lg_printed is not None

    def check_scene(self, scene: Scene) -> None:
        super().check_scene(scene)
        coordinates = scene.exact_hamiltonian().coordinates
        if _COORDINATE.fullmatch(self._name) and self._name not in coordinates:
            raise unknown_name("of", self._name, coordinates)

    def observables(self) -> tuple[str, ...]:
        # The change of a coordinate is that of a function of the state.
        return (self._name if observables.find(self._name) else f"integral_error: {self._name}",)

    def printed_texts(self) -> list[str]:
        return [x for x in (self.printed, self.lg_printed, self.at_most, self.at_least) if x]

    def compare(self, findings: Findings) -> ClaimResult:
        value, runs = self.compute(findings)
        (text,) = self.printed_texts()
        if not is_representable(value):
            evidence = prose(f"{self.label} is no number that is known, or a value is 0{runs}")
            return self.result(Verdict.UNDECIDED, evidence)
        if self.at_most is None and self.at_least is None:
            answer = rounds_to(value, text)
            relation = ROUNDING[answer]
        else:
            answer, relation = _is_within(value, self.at_most, self.at_least)
        digits = format_ball(value, len(text.partition("e")[0]) + MORE_DIGITS)
        evidence = prose(f"{self.label} = ", number(digits), f", {relation} ", Number(text), runs)
        return self.result(all_hold([answer]), evidence)

    def compute(self, findings: Findings) -> tuple[Ball, str]:
        """Return the number, and of which runs it is, in words."""
        run = self.only_run(findings)
        value = self.value_of_run(findings, run)
        value = lg(value) if self.lg_printed is not None else value
        return value, f", in {run.steps} steps"

    @property
    def label(self) -> str:
        """The number in words."""
        observable = observables.find(self._name)
        label = observable.label if observable else self._name
        label = f"|{label}|" if self._is_size else label
        label = f"lg {label}" if self.lg_printed is not None else label
        return f"{label}, relative," if self.relative else label

    def value_of_run(self, findings: Findings, run: RunResult) -> Ball:
        """Return the number of a run, not its logarithm."""
        (name,) = self.observables()
        value = ball(run.values[name])
        if name != self._name:
            value += rational_ball(_initial_state(run)[self._name])
        value = abs(value) if self._is_size else value
        if self.relative:
            value /= abs(self._initial_value(findings, run))
        return value

    def _initial_value(self, findings: Findings, run: RunResult) -> Ball:
        """Return the energy, or the integral, of the initial state; InputError if it is 0."""
        hamiltonian = findings.scene(self.scene).exact_hamiltonian()
        observable = observables.find(self._name)
        formula = observable.integral if observable else ""
        integral = hamiltonian.expression if formula == ENERGY else parse(formula)
        field, (element,) = field_of(hamiltonian, hamiltonian.substitute_values(integral))
        value = enclose(field.ring, element, _initial_state(run), _PRECISION)
        if value is None or value.contains(0):
            raise InputError("relative", True, "is in parts of an initial value, which is 0 here")
        return value


def _initial_state(run: RunResult) -> dict[str, Fraction]:
    if isinstance(run.q, str) and isinstance(run.p, str):
        return {"p": Fraction(run.p), "q": Fraction(run.q)}
    pairs = ((letter, getattr(run, letter)) for letter in "pq")
    return {f"{name}{k}": Fraction(x) for name, z in pairs for k, x in enumerate(z, start=1)}


def _is_within(value: Ball, most: str | None, least: str | None) -> tuple[bool | None, str]:
    """Return True if the value is at most, or at least, a number, and what it is, in words."""
    low, high = bounds(value)
    bound = Fraction(most or least or 0)
    if most is not None:
        answer = True if high <= bound else False if low > bound else None
        return answer, {True: "at most", False: "more than", None: "not known to be at most"}[
            answer
        ]
    answer = True if low >= bound else False if high < bound else None
    return answer, {True: "at least", False: "less than", None: "not known to be at least"}[answer]


CLAIM = RunValueClaim
