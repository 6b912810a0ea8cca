"""What every format of the report says in the same words: the terms, and what its tables hold."""

from collections.abc import Mapping

from markupsafe import Markup

from verify import arithmetic as number_systems
from verify.pages.text.typography import listed, whole
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
CLOCK = (
    "H depends on time, so float64’s clock, t ← t + h, is a part of its own, between input and "
    "trajectory: what its errors do to the motion in exact arithmetic."
)
FORM_SEPARATION = (
    "W in float64 is truncation + rounding, and rounding the plain way is input + trajectory + "
    "derivatives + product, entry by entry of a matrix; of each the greatest |entry| at the end of "
    "the run stands here, the greatest part bold, and all entries are in results.json. The plain "
    "way multiplies the steps’ Jacobians and takes MᵀΩM − Ω; the closed form sums MᵀSM."
)
FORM_GROWTH = (
    "W sums MᵀSM, and a 2-form grows as areas do under M: like ‖∧²M‖, the root of the sum of all "
    "squares of 2 × 2 minors, which is below ‖M‖². Where ‖M‖ grows exponentially at half the "
    "step size too, and at about that rate, the growth is the motion’s and not the scheme’s. The "
    "finite-time Lyapunov exponent is ln(‖M‖/√(2n))/T of this run, by unit of time. The law of "
    "max |W| is the slope of its envelope over N, in logarithms: bounded, N or N² where one of "
    "these is near, and fitted only where ‖M‖ does not grow exponentially."
)
ROUNDING_GROWTH = (
    "The exponent is the slope of the greatest |rounding| so far over N, in logarithms, with its "
    "standard error. Errors of both signs make a random walk, N to the ½; errors of one sign "
    "drift, N to the 1. A run is named by the one of the two that lies within 2.5 standard errors, "
    "and undecided where both do or neither."
)
COSTS = "Orders, and what one step executes (a subexpression that occurs twice is computed once)"
WORK = "Errors at T and run times, by scheme and step size; the first four known digits"

ALWAYS = {
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
# Where there are several degrees of freedom.
OF_FORM = {
    "S": Markup(
        "JᵀΩJ − Ω, by how much one step changes the symplectic form Ω = Σ dp<sub>i</sub> ∧ "
        "dq<sub>i</sub>; max |S| is the largest entry in any step. S = 0 is more than det J = 1."
    ),
    "W": Markup("The same of all steps together: W ← W + MᵀSM, with M the Jacobian so far."),
}
# Terms that several sections need.
SEPARATED = {
    "Truncation, rounding": Markup(
        "Truncation is Λ in exact arithmetic from the exact inputs: all that the scheme itself "
        "does to area, since the exact flow has Λ = 0. Rounding is all that float64 adds to it, "
        "split along a chain so that the parts add up exactly: <code>input</code>, the step size, "
        "parameters and initial values rounded; <code>trajectory</code>, the states stepped in "
        "float64; <code>determinant</code>, det J (or ΔJ) of each step rounded; "
        "<code>product</code>, their product (or sum of logarithms) rounded."
    )
}
SEPARATED_FORM = {
    "Truncation, rounding in W": Markup(
        "Truncation is W in exact arithmetic from the exact inputs. Rounding is all that float64 "
        "adds to it, split along a chain so that the parts add up exactly: <code>input</code>, the "
        "step size, parameters and initial values rounded; <code>trajectory</code>, the states "
        "stepped in float64; <code>derivatives</code>, J (or S) of each step rounded; "
        "<code>product</code>, products of matrices and their sums rounded."
    )
}
RAN = {
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

# -- counts of judged runs in a sentence ----------------------------------------------------------

_COUNTED: dict[Kind, str] = {
    "stable": "stable",
    "drifts": "drifting",
    "unstable: scheme": "unstable by the scheme",
    "unstable: arithmetic": "unstable by the arithmetic",
    "escapes": "escaping",
    "overflow": "overflowing",
    "underflow": "underflowing",
    "sensitive": "sensitive",
    "undecided": "undecided",
}


def counts_of(counted: Mapping[Kind, int]) -> str:
    """How many of each kind there are: a kind's name is a verb or has a colon, and reads badly."""
    return listed(f"{whole(counted[kind])} {_COUNTED[kind]}" for kind in KINDS if counted.get(kind))
