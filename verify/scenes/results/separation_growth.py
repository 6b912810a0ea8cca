"""How the parts of a separation grow: with N, as h falls, and with the tangent map of the run."""

from typing import Literal

from verify.scenes.frozen import Frozen, Said, WithProse


class GrowthResult(WithProse):
    """A `verify.studies.separation.growth.Growth`."""

    exponent: str | None
    standard_error: str | None
    name: Literal["random walk", "drift", "undecided"]
    reason: Said
    first: int
    last: int
    points: int


class PowerLawResult(WithProse):
    """A `verify.studies.separation.growth.PowerLaw`: measured, not proved."""

    exponent: str | None
    standard_error: str | None
    name: Literal["bounded", "N", "N²", "exponential", "undecided"]
    reason: Said


class TangentGrowth(WithProse):
    """How M, the product of the Jacobians that float64 computed, grew, and what follows for W.

    `norm_squared`: ‖M_N‖² of Frobenius. `areas`: ‖∧²M_N‖, the root of the sum of all squares of its
    2 × 2 minors, as which a 2-form grows, and which is below ‖M_N‖². `finite_time_lyapunov`:
    ln(‖M_N‖/√(2n))/T per unit of time, `time` T. `motion`: whether ‖M‖ grew exponentially in this
    run, and then `cause`, whose that growth is: `at_half_step` is the exponent over the same time
    with half the step size (`verify.studies.separation.tangent`). `law`, `law_of_areas`: those
    of ‖M‖² and ‖∧²M‖ where it did not. `per_area`: the greatest |entry| of the truncation of W_N,
    over ‖∧²M_N‖.
    """

    norm_squared: str
    areas: str
    time: str
    finite_time_lyapunov: str
    motion: Literal["exponential", "polynomial", "undecided"]
    cause: Literal["motion", "scheme", "undecided"] | None
    at_half_step: str | None
    law: PowerLawResult
    law_of_areas: PowerLawResult
    per_area: str
    meaning: Said


class CrossoverResult(Frozen):
    """A `verify.studies.separation.growth.Crossover`."""

    step_size: str | None
    bracket: tuple[str, str] | None
    reason: str
