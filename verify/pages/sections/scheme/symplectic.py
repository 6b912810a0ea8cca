"""The proof of a scheme in n degrees of freedom: S = JᵀΩJ − Ω, entry by entry, and det J."""

from verify.pages.sections.section import ReportSection
from verify.pages.text import legend

SECTION = ReportSection(
    order=15,
    view=lambda _, proof, __: proof if proof.form else None,
    terms=lambda _: legend.terms_of("form"),
)
