"""The legend of a page: signs of verdicts, terms with their meanings, kinds of runs in words.

Terms that several sections explain in the same words are defined here.
"""

from collections.abc import Mapping

from markupsafe import Markup

from verify import arithmetic as number_systems
from verify.pages.text.typography import join_and, whole
from verify.scenes.results.stability import KINDS, Kind
from verify.verdict import Verdict

# The sign of each verdict, beside its colour, and its meaning.
SIGNS = {
    Verdict.PROVED: ("✓", "exact algebra shows it"),
    Verdict.ENCLOSED: ("⊂", "a rigorous numeric enclosure shows it; its error bound is certain"),
    Verdict.MEASURED: ("≈", "numbers show it; their error bounds are estimates, not certificates"),
    Verdict.REFUTED: ("✗", "a counterexample, or the proof of the contrary, contradicts it"),
    Verdict.UNDECIDED: ("?", "neither shown nor contradicted by what was computed"),
}
# Terms of every page.
ALWAYS = {
    "ΔJ": Markup(
        "det J − 1, by how much one step changes area, or volume in more than two coordinates, "
        "with J the Jacobian matrix of the step map z → z′. It is evaluated from its closed form, "
        "not as a difference from 1, which would cancel."
    ),
    "MSE": Markup("The mean of ΔJ² over the N steps; lg MSE is its decimal logarithm."),
    "Λ": Markup(
        "Π (1 + ΔJ) − 1 over the N steps: by how much all steps together change it. "
        "<em>By closed form</em>: from the closed form of ΔJ. <em>The plain way</em>: four entries "
        "of J, determinant, product, minus one, all in working precision, as one would program it "
        "at first."
    ),
}
# Terms of n degrees of freedom.
FORM_TERMS = {
    "S": Markup(
        "JᵀΩJ − Ω, by how much one step changes the symplectic form Ω = Σ dp<sub>i</sub> ∧ "
        "dq<sub>i</sub>; max |S| is the largest entry in any step. S = 0 is more than det J = 1."
    ),
    "W": Markup("The same of all steps together: W ← W + MᵀSM, with M the Jacobian so far."),
}
# Terms of separations, in Λ and in W, and of runs.
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
FORM_SEPARATION_TERMS = {
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

_ADJECTIVES: dict[Kind, str] = {
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


def counts_of(counts: Mapping[Kind, int]) -> str:
    """Return the counts of the kinds with adjectives, as the names of the kinds fit no sentence."""
    return join_and(
        f"{whole(counts[kind])} {_ADJECTIVES[kind]}" for kind in KINDS if counts.get(kind)
    )
