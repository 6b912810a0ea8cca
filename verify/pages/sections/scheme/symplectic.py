"""The proof of a scheme in n degrees of freedom: S = JᵀΩJ − Ω, entry by entry, and det J."""

from verify.pages.sections.section import Section
from verify.pages.text import words

SECTION = Section(
    order=15,
    view=lambda _, proof, __: proof if proof.form else None,
    terms=lambda _: words.OF_FORM,
)
