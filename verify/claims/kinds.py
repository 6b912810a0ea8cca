"""Claims of a paper: what each kind states. `verify.claims.file` reads them, `check_claims` judges.

A claim speaks of one scheme and of one scene, which has its Hamiltonian and its runs, or of a
scheme and every H. A claim's own value stands under the name of its kind where it has one
(`order = 3`), and its verdict always comes with evidence.
"""

import re
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from verify.errors import InputError
from verify.scenes.frozen import Frozen
from verify.scenes.values import Number, StepSize

EVERY_SEPARABLE = "separable hamiltonian"
_PRINTED = re.compile(r"-?\d{1,20}(\.\d{1,1000})?(e[+-]?\d{1,3})?", re.ASCII)


class _Claim(Frozen):
    id: Annotated[str, Field(pattern=r"^[^\s\x00-\x1f]+$", max_length=80)]
    source: str = ""
    section: str = ""
    statement: str = ""
    scene: str = ""
    scheme: str


class _Quantified(_Claim):
    """A claim that may be made of every H; then it has no scene."""

    every: Literal["hamiltonian", "separable hamiltonian"] | None = None


# -- what algebra decides -------------------------------------------------------------------------


class StepMapClaim(_Claim):
    """The scheme's step map is this one; `q_next` may use p_next."""

    kind: Literal["step_map"]
    p_next: str
    q_next: str


class JacobianClaim(_Claim):
    """The Jacobian's entries (Eq. 12), by rows."""

    kind: Literal["jacobian"]
    entries: tuple[tuple[str, str], tuple[str, str]]


_Order = Annotated[int, Field(ge=1, le=64, strict=True)]


class DeltaJClaim(_Quantified):
    """ΔJ is `formula`: exactly, or up to O(h^up_to).

    `delta_j`: printed as ΔJ itself. `mse_summand`: printed inside the square of Eq. 15.
    `lambda_factor`: printed as the factor det J of Eq. 16. Of every H, with the derivatives of H as
    names, up to the first term.
    """

    kind: Literal["delta_j", "mse_summand", "lambda_factor"]
    formula: str
    up_to: _Order | None = None


class OrderClaim(_Quantified):
    """ΔJ = c h^order + …, c not the zero function; with `at_least`, ΔJ = O(h^order)."""

    kind: Literal["order"]
    order: _Order
    at_least: bool = False


class ConvergenceOrderClaim(_Quantified):
    """The global error is of this order in h, no higher one; with `at_least`, or of a higher one.

    The map agrees with the exact flow up to h to this power.
    """

    kind: Literal["convergence_order"]
    convergence_order: _Order
    at_least: bool = False


class AreaClaim(_Quantified):
    """det J ≡ 1; or, where it is false, not so."""

    kind: Literal["area_preserving"]
    area_preserving: Annotated[bool, Field(strict=True)]


# -- what runs decide -----------------------------------------------------------------------------


def _as_printed(given: Any) -> str:
    """The text of a number as a paper prints it; TOML's decimals are texts already."""
    shown = str(given) if isinstance(given, int) and not isinstance(given, bool) else given
    if isinstance(shown, str):
        shown = shown.strip().replace("\N{MINUS SIGN}", "-").replace("E", "e")
        if _PRINTED.fullmatch(shown):
            return shown
    raise InputError("number", given, "is not a printed decimal, such as -7.3010 or 1.53e-17")


Printed = Annotated[str, BeforeValidator(_as_printed)]
Row = Annotated[tuple[Printed, ...], Field(min_length=1, max_length=1000)]


class ValueClaim(_Claim):
    """MSE, or Λ, of one run as printed; or its lg, for Λ that of |Λ|."""

    kind: Literal["mse", "lambda"]
    printed: Printed | None = None
    lg_printed: Printed | None = None

    @model_validator(mode="after")
    def _check(self) -> Self:
        if (self.printed is None) == (self.lg_printed is None):
            raise InputError("printed, lg_printed", "", "give one of the two")
        return self


class TableClaim(_Claim):
    """Printed values, lg MSE by default, for each step size.

    `printed` is one row that every initial value has, `rows` one row for each initial value.
    """

    kind: Literal["table"]
    quantity: Literal["lg_mse", "mse", "lambda", "lg_abs_lambda"] = "lg_mse"
    step_sizes: Annotated[tuple[StepSize, ...], Field(min_length=1)]
    printed: Row | None = None
    rows: Annotated[tuple[Row, ...], Field(min_length=1, max_length=1000)] | None = None

    @model_validator(mode="after")
    def _check(self) -> Self:
        if (self.printed is None) == (self.rows is None):
            raise InputError("printed, rows", "", "give one of the two")
        name = "printed" if self.rows is None else "rows"
        for row in self.rows or (self.printed or (),):
            if len(row) != len(self.step_sizes):
                raise InputError(name, len(row), f"give {len(self.step_sizes)} values in a row")
        return self


Quantity = Literal["mse", "abs_lambda", "mse_over_lambda", "delta_j_max"]


class SpreadClaim(_Claim):
    """At each step size the quantity varies over the initial values by this factor at most."""

    kind: Literal["spread"]
    quantity: Quantity
    factor: Annotated[Number, Field(ge=1)]


class MonotoneClaim(_Claim):
    """For each initial value the quantity does this as the step size increases."""

    kind: Literal["monotone"]
    quantity: Quantity
    direction: Literal["increases", "decreases"]


class LessClaim(_Claim):
    """The one quantity is smaller than the other at each step size and initial value."""

    kind: Literal["less"]
    quantity: Quantity
    than: Quantity


class MagnitudeClaim(_Claim):
    """At `step_size` each quantity is about 10^its exponent: its lg within ½ of it.

    For some initial value of the grid, or for every one.
    """

    kind: Literal["magnitude"]
    step_size: StepSize
    exponents: Annotated[dict[Quantity, int], Field(min_length=1)]
    quantifier: Literal["some", "every"]


class BoundedClaim(_Claim):
    """|Λ| ≤ bound after every step of every run."""

    kind: Literal["bounded"]
    bound: Annotated[Number, Field(ge=0)]


class GrowthClaim(_Claim):
    """How the greatest |Λ| of [0, t] grows as t goes on to the end of the run."""

    kind: Literal["growth"]
    growth: Literal["bounded", "linear"]


class CriteriaClaim(_Claim):
    """The scheme satisfies these criteria."""

    kind: Literal["criteria"]
    numbers: Annotated[
        tuple[Annotated[int, Field(ge=1, le=4, strict=True)], ...], Field(min_length=1)
    ]


class FlowClaim(_Claim):
    """Of images by a scheme, or by the `exact flow`, in the scene's `[[flow]]` of these sources."""

    flows: Annotated[tuple[str, ...], Field(min_length=1, max_length=100)]


class FlowAreaClaim(FlowClaim):
    """The map preserves the region's area: exactly, or changes it by this part of it at most."""

    kind: Literal["flow_area"]
    within: Annotated[Number, Field(gt=0)] | None = None


class FlowDistanceClaim(FlowClaim):
    """The images' outlines lie so close to those by the exact flow (Hausdorff distance)."""

    kind: Literal["flow_distance"]
    within: Annotated[Number, Field(gt=0)]


class TheoremClaim(_Claim):
    """What a paper says in words, judged by the function of that `name` in
    `verify.claims.theorems`.
    """

    kind: Literal["theorem"]
    name: str
    scheme: str = ""


Claim = (
    StepMapClaim
    | JacobianClaim
    | DeltaJClaim
    | OrderClaim
    | ConvergenceOrderClaim
    | AreaClaim
    | ValueClaim
    | TableClaim
    | SpreadClaim
    | MonotoneClaim
    | LessClaim
    | MagnitudeClaim
    | BoundedClaim
    | GrowthClaim
    | CriteriaClaim
    | FlowAreaClaim
    | FlowDistanceClaim
    | TheoremClaim
)
KINDS: dict[str, type[Claim]] = {
    kind: model
    for model in Claim.__args__
    for kind in model.model_fields["kind"].annotation.__args__
}
EXACT = (
    StepMapClaim,
    JacobianClaim,
    DeltaJClaim,
    OrderClaim,
    ConvergenceOrderClaim,
    AreaClaim,
    TheoremClaim,
)
