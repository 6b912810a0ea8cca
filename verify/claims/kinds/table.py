"""Printed values, lg MSE by default, for each step size."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import product, repeat
from typing import Annotated, Literal, NamedTuple, Self

from pydantic import Field, model_validator

from verify.arithmetic.arb import Ball, is_representable, lg, rational_ball
from verify.arithmetic.exact import text
from verify.claims.base_claim import Findings
from verify.claims.quantities import (
    QUANTITIES,
    PrintedRow,
    all_hold,
    cell,
    holds,
    middle,
    places,
    rounds_to,
    short,
    start_of,
)
from verify.claims.run_claims import RunClaim
from verify.claims.table_script import table_script
from verify.errors import NOT_GIVEN, InputError
from verify.prose import Formula, Prose, join_prose, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.scenes.values import StepSize
from verify.verdict import Verdict


class Entries(NamedTuple):
    """Verdicts on printed values, the values that were computed, and both as a table."""

    verdicts: list[list[bool | None]]
    values: list[Ball]
    details: list[list[str]]


class PrintedTableClaim(RunClaim):
    """`printed` is one row that every initial value has, `rows` one row for each initial value."""

    kind: Literal["table"]
    quantity: Literal["lg_mse", "mse", "lambda", "lg_abs_lambda"] = "lg_mse"
    """The printed quantity."""
    step_sizes: Annotated[tuple[StepSize, ...], Field(min_length=1)]
    """The step sizes, in the order of the values."""
    printed: PrintedRow | None = None
    """One row that every initial value has; or `rows`."""
    rows: Annotated[tuple[PrintedRow, ...], Field(min_length=1, max_length=1000)] | None = None
    """A row for each initial value; or `printed`."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if (self.printed is None) == (self.rows is None):
            raise InputError("printed, rows", NOT_GIVEN, "give one of the two")
        name = "printed" if self.rows is None else "rows"
        for row in self.rows or (self.printed or (),):
            if len(row) != len(self.step_sizes):
                raise InputError(name, len(row), f"give {len(self.step_sizes)} values in a row")
        return self

    def quantities(self) -> tuple[str, ...]:
        return (self.quantity,)

    def printed_texts(self) -> list[str]:
        return [cell for row in self.rows or (self.printed or (),) for cell in row]

    def check_scene(self, scene: Scene) -> None:
        if scene.grid is None:
            return
        count = len(scene.grid.initial_values)
        if self.rows is not None and len(self.rows) != count:
            raise InputError("rows", len(self.rows), f"give {count}, one an initial value")
        for h in self.step_sizes:
            if h not in scene.grid.step_sizes:
                raise InputError("step_size", text(h), "is not in the scene's grid")

    def compare(self, findings: Findings) -> ClaimResult:
        rows = self.run_rows(findings)
        verdicts, values, details = self.entries(rows)
        entries = [verdict for row in verdicts for verdict in row]
        if False not in entries:
            evidence = self.describe_range(values) + ", as printed"
            return self.result(all_hold(entries), evidence, details)
        scene = findings.scene(self.scene)
        # What the row is says more than that it is wrong, and stands first.
        evidence = prose(
            self._describe_identities(rows[0], scene.grid.time if scene.grid else None),
            self._describe_wrong(verdicts), ": ", self.describe_range(values),
        )  # fmt: skip
        result = self.result(Verdict.REFUTED, evidence, details)
        # Of an MSE that is 0 a program would end in the logarithm of 0.
        script = self._script(scene, rows) if all(map(is_representable, values)) else ""
        return result.model_copy(update={"reproduction": script})

    def _script(self, scene: Scene, rows: Sequence[Sequence[RunResult]]) -> str:
        """Return a program that prints the values that were computed."""
        if any(isinstance(row[0].q, tuple) or isinstance(row[0].p, tuple) for row in rows):
            return ""
        starts = [(Fraction(str(row[0].q)), Fraction(str(row[0].p))) for row in rows]
        sizes = [(h, self.run_at(rows[0], h).steps) for h in self.step_sizes]
        return table_script(scene.exact_hamiltonian(), self.scheme, self.quantity, starts, sizes)

    def entries(self, rows: Sequence[Sequence[RunResult]]) -> Entries:
        """Return the verdicts on the printed values, a row per initial value, and the values."""
        printed_rows = self.rows or (self.printed or (),) * len(rows)
        if len(printed_rows) != len(rows):
            raise InputError(f"claim {self.id}: rows", len(printed_rows), f"give {len(rows)} rows")
        details: list[list[str]] = [["initial value", *(f"h = {text(h)}" for h in self.step_sizes)]]
        if self.printed is not None:
            details.append(["printed, for all", *self.printed])
        verdicts: list[list[bool | None]] = []
        values: list[Ball] = []
        for row, printed in zip(rows, printed_rows, strict=True):
            runs = [self.run_at(row, h) for h in self.step_sizes]
            verdicts.append([*map(holds, runs, repeat(self.quantity), printed)])
            if self.rows is not None:
                details.append([prose("printed, ", start_of(row[0])), *printed])
            cells = map(cell, runs, repeat(self.quantity), map(places, printed))
            details.append([start_of(row[0]), *cells])
            values += [QUANTITIES[self.quantity](run) for run in runs]
        return Entries(verdicts, values, details)

    def _describe_wrong(self, verdicts: Sequence[Sequence[bool | None]]) -> str:
        """Describe how many of the printed entries are wrong."""
        if self.printed is None:
            entries = [verdict for row in verdicts for verdict in row]
            return f"{entries.count(False)} of {len(entries)} entries are wrong"
        columns, label = list(zip(*verdicts, strict=True)), QUANTITIES[self.quantity].label
        several = f" from any of the {len(verdicts)} initial values" if len(verdicts) > 1 else ""
        if all(verdict is False for column in columns for verdict in column):
            return f"none of the {len(columns)} printed values is the {label}{several}"
        wrong = sum(False in column for column in columns)
        of_each = " from each of the initial values" if several else ""
        return f"{wrong} of the {len(columns)} printed values are not the {label}{of_each}"

    def describe_range(self, values: Sequence[Ball]) -> Prose:
        label = QUANTITIES[self.quantity].label
        finite = sorted((v for v in values if is_representable(v)), key=middle)
        if not finite:
            return prose(f"no computed {label} is known")
        low, high = (number(short(v, self.quantity)) for v in (finite[0], finite[-1]))
        return prose(f"computed {label} lies between ", low, " and ", high)

    def _describe_identities(self, row: Sequence[RunResult], time: Fraction | None) -> Prose:
        """Identify a wrong row as the logarithm of a product, if it is one."""
        if self.quantity != "lg_mse" or self.printed is None:
            return prose("")
        runs = [self.run_at(row, h) for h in self.step_sizes]
        names = [Formula(f"lg({_monomial(e)})") for e in _identities(runs, self.printed, time)]
        if not names:
            return prose("")
        return prose("the printed row is ", join_prose(" = ", names), " to all its digits; ")


def _identities(
    runs: Sequence[RunResult], printed: Sequence[str], time: Fraction | None
) -> list[tuple[int, int, int]]:
    """Return the products hᵃ Nᵇ Tᶜ whose lg is the printed row to all digits, simplest first.

    Only small exponents are tried. As N h = T (up to a step), one of a, b, c can be taken as 0.
    """
    products = []
    for exponents in product(range(-6, 7), range(-3, 4), range(-3, 4)):
        # As N h = T, a product with three non-zero exponents equals one with two.
        if 0 not in exponents or not any(exponents):
            continue
        if all(
            rounds_to(lg(_power(run, time, exponents)), cell) is True
            for run, cell in zip(runs, printed, strict=True)
        ):
            products.append(exponents)
    return sorted(products, key=lambda exponents: (sum(map(abs, exponents)), exponents))


def _power(run: RunResult, time: Fraction | None, exponents: tuple[int, int, int]) -> Ball:
    a, b, c = exponents
    h, steps = Fraction(run.step_size), Fraction(run.steps)
    # The length of the run is T as printed; N h differs from it by up to one step.
    length = h * steps if time is None else time
    return rational_ball(h**a * steps**b * length**c)


def _monomial(exponents: tuple[int, int, int]) -> str:
    above = [_factor(n, e) for n, e in zip("hNT", exponents, strict=True) if e > 0]
    below = [_factor(n, -e) for n, e in zip("hNT", exponents, strict=True) if e < 0]
    return (" ".join(above) or "1") + (f"/{' '.join(below)}" if below else "")


def _factor(name: str, exponent: int) -> str:
    return name if exponent == 1 else f"{name}^{exponent}"


CLAIM = PrintedTableClaim
