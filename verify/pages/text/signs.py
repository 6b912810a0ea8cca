"""The sign of each verdict, beside its colour, and its meaning."""

from verify.verdict import Verdict

SIGNS = {
    Verdict.PROVED: ("✓", "exact algebra shows it"),
    Verdict.ENCLOSED: ("⊂", "a rigorous numeric enclosure shows it; its error bound is certain"),
    Verdict.MEASURED: ("≈", "numbers show it; their error bounds are estimates, not certificates"),
    Verdict.REFUTED: ("✗", "a counterexample, or the proof of the contrary, contradicts it"),
    Verdict.UNDECIDED: ("?", "neither shown nor contradicted by what was computed"),
}
