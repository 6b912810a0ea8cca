"""What every format of the report says in the same words: the terms, and what its tables hold."""

from collections.abc import Iterator, Mapping, Sequence

from markupsafe import Markup

from verify import arithmetic as number_systems
from verify.pages.text.typography import listed, whole
from verify.scenes.results.report import SceneResult
from verify.scenes.results.stability import KINDS, Kind

RUNS = (
    "Only known digits are printed, each value with its error bound. “|·| ≤” stands where no digit "
    "is known."
)
JUDGED = (
    "Bounds are ten times the exact orbit’s reach in p and in q, and a hundred times its energy "
    "scale. Each run is done in float64, in 40 digits or more, where they differ in twice as many, "
    "and where float64’s range may be to blame in 53 bits with wider exponents."
)
GROWTH_LAW = (
    "boundary + secular = log(1 + Λ), of which “predicted” is the Λ; “difference” is what it "
    "differs by, divided by the measured |Λ|. The first four known digits are printed; all are in "
    "results.json."
)
SEPARATION = (
    "Λ in float64 is truncation + rounding, and rounding the plain way is input + trajectory + "
    "determinant + product, the greatest of them bold. All are those at the end of the run, and "
    "only known digits are printed, the first four of them; all are in results.json. With each "
    "rounding stands by how many decades its greatest size along the run is below, or above, that "
    "of truncation. “|·| ≤” stands where no digit is known."
)
ROUNDING_GROWTH = (
    "The exponent is the slope of the greatest |rounding| so far over N, in logarithms, with its "
    "standard error. Errors of both signs make a random walk, N to the ½; errors of one sign "
    "drift, N to the 1. A run is named by the one of the two that lies within 2.5 standard errors, "
    "and undecided where both do or neither."
)
COSTS = "Orders, and what one step executes (a subexpression that occurs twice is computed once)"
WORK = "Errors at T and run times, by scheme and step size; the first four known digits"

_ALWAYS = {
    "ΔJ": Markup(
        "det J − 1, by how much one step changes area, with J the Jacobian matrix of the step map "
        "(p, q) → (p′, q′). It is evaluated from its closed form, not as a difference from 1, "
        "which would cancel."
    ),
    "MSE": Markup("The mean of ΔJ² over the N steps; lg MSE is its decimal logarithm."),
    "Λ": Markup(
        "Π (1 + ΔJ) − 1 over the N steps: by how much all steps together change area. "
        "<em>By closed form</em>: from the closed form of ΔJ. <em>The plain way</em>: four entries "
        "of J, determinant, product, minus one, all in working precision, as one would program it "
        "at first."
    ),
}
_SEPARATED = {
    "Truncation, rounding": Markup(
        "Truncation is Λ in exact arithmetic from the exact inputs: all that the scheme itself "
        "does to area, since the exact flow has Λ = 0. Rounding is all that float64 adds to it, "
        "split along a chain so that the parts add up exactly: <code>input</code>, the step size, "
        "parameters and initial values rounded; <code>trajectory</code>, the states stepped in "
        "float64; <code>determinant</code>, det J (or ΔJ) of each step rounded; "
        "<code>product</code>, their product (or sum of logarithms) rounded."
    ),
}
_CROSSED = {
    "Crossover h*": Markup(
        "The step size below which rounding is larger than truncation, interpolated in logarithms "
        "between the two step sizes that bracket it. Smaller steps than h* make Λ no better."
    ),
}
_GROWN = {
    "Growth law": Markup(
        "log(1 + Λ) as a bounded part, a secular part that grows with T, and a remainder of proved "
        "order. X is the derivative along the exact flow; [F] is F at the end of the run minus F "
        "at its start; X G is the leading coefficient of ΔJ; ⟨g⟩ is the time average of g along "
        "the exact orbit, and B the bounded rest, X B = g − ⟨g⟩."
    ),
}
_CARRIED = {
    "Change of area": Markup(
        "The area inside the image of a closed outline, less that inside the outline, divided by "
        "the latter: ∮ p dq along both, refined until the quadrature’s own error is far below the "
        "change. It equals the mean of Λ over the region, which is computed beside it without any "
        "area."
    ),
    "Distance of outlines": Markup(
        "Hausdorff’s: the farthest that a point of either outline is from the other one."
    ),
}
_TIMED = {
    "Limited by rounding": Markup(
        "The float64 run differs from the same steps in exact arithmetic by a part of its error "
        "that counts: smaller steps make it no better. Such points are hollow, and no slope is "
        "fitted to them."
    ),
}
_RAN = {
    "Enclosed, estimated": Markup(
        "How an error bound was got. <em>Enclosed</em>: rigorous, the value is proved to lie "
        "within it. <em>Estimated</em>: from a rerun at higher precision, which certifies nothing "
        "by itself."
    ),
    "Number systems": Markup(" ").join(
        Markup("<code>{}</code>: {}.").format(system.name, system.about)
        for system in sorted(
            map(number_systems.about, number_systems.names()), key=lambda x: x.cost
        )
    ),
}


def terms(scenes: Sequence[SceneResult], *, gallery: bool = False) -> Iterator[tuple[str, Markup]]:
    """The terms that the scenes' results, and a gallery of them, need, with what each means."""
    yield from _ALWAYS.items()
    separated = any(s.separations or s.crossovers for s in scenes)
    if separated or gallery:
        yield from _SEPARATED.items()
    if separated:
        yield from _CROSSED.items()
    if any(s.growth_laws for s in scenes):
        yield from _GROWN.items()
    if any(s.flows for s in scenes):
        yield from _CARRIED.items()
    if any(s.work_precision for s in scenes):
        yield from _TIMED.items()
    if gallery or any(_ran(s) for s in scenes):
        yield from _RAN.items()


def _ran(s: SceneResult) -> bool:
    return bool(s.runs or s.series or s.separations or s.crossovers or s.work_precision)


# -- counts of judged runs in a sentence ----------------------------------------------------------

_COUNTED: dict[Kind, str] = {
    "stable": "stable",
    "drifts": "drifting",
    "unstable: scheme": "unstable by the scheme",
    "unstable: arithmetic": "unstable by the arithmetic",
    "escapes": "escaping",
    "overflow": "overflowing",
    "underflow": "underflowing",
    "undecided": "undecided",
}


def counts_of(counted: Mapping[Kind, int]) -> str:
    """How many of each kind there are: a kind's name is a verb or has a colon, and reads badly."""
    return listed(f"{whole(counted[kind])} {_COUNTED[kind]}" for kind in KINDS if counted.get(kind))
