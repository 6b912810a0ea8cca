"""What is proved of a scheme: its map, its Jacobian matrix, ΔJ and both orders."""

from dataclasses import dataclass

from markupsafe import Markup

from verify.pages.sections.section import Section
from verify.pages.text import mathml
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import SceneResult

_HALF = 70  # characters of formulas that half of the page has room for


@dataclass(frozen=True)
class ProofView:
    """`matrix` and `leading` are None where they are not known or too long to be shown."""

    proof: ProofResult
    matrix: Markup | None
    leading: Markup | None

    @property
    def is_short(self) -> bool:
        """Whether the map and ΔJ have room beside one another."""
        shown = self.proof.shown
        rows = [" ".join(row) for row in shown.jacobian or ()]
        return all(len(text) <= _HALF for text in (*rows, shown.delta_j or ""))


def _view(_: SceneResult, proof: ProofResult, __: str) -> ProofView | None:
    if proof.form is not None:
        return None
    jacobian, leading = proof.shown.jacobian, proof.shown.leading or proof.leading
    return ProofView(
        proof=proof,
        matrix=mathml.matrix(mathml.NAMED["J"], jacobian) if jacobian else None,
        leading=None if proof.order is None else mathml.order_equation(leading, proof.order),
    )


SECTION = Section(order=10, view=_view)
