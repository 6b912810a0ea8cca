"""What is proved of a scheme in n degrees of freedom: S = JᵀΩJ − Ω, entry by entry, and det J."""

from dataclasses import dataclass

from verify.pages.sections.section import Section
from verify.pages.text import words
from verify.scenes.results.proof import FormResult, ProofResult
from verify.scenes.results.report import SceneResult

_LONGEST = 400  # characters of a potential that is shown


@dataclass(frozen=True)
class FormView:
    """The proof, and what it says in n degrees of freedom; `potential` where it is short enough."""

    proof: ProofResult
    form: FormResult
    potential: str


def _view(_: SceneResult, proof: ProofResult, __: str) -> FormView | None:
    form = proof.form
    if form is None:
        return None
    potential = form.potential if len(form.potential) <= _LONGEST else ""
    return FormView(proof, form, potential)


SECTION = Section(order=15, view=_view, terms=lambda _: words.OF_FORM)
