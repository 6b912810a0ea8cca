"""What holds of a scheme for every Hamiltonian, where that was asked for."""

from dataclasses import dataclass

from markupsafe import Markup

from verify.pages.sections.section import Section
from verify.pages.text.prose import prose, sentence
from verify.prose import Formula, Prose
from verify.scenes.results.proof import EveryResult, ProofResult
from verify.scenes.results.report import SceneResult

_LONGEST_POTENTIAL = 200  # characters of a G that stands in a sentence


@dataclass(frozen=True)
class EveryView:
    """The result, and what it says in sentences."""

    result: EveryResult
    finding: Markup


def _view(scene: SceneResult, proof: ProofResult, _: str) -> EveryView | None:
    own = next((each for each in scene.every if each.scheme == proof.scheme), None)
    return EveryView(own, _finding(own)) if own else None


def _finding(every: EveryResult) -> Markup:
    found = [sentence(every.reason)]
    if every.degrees > 1:
        if every.order is not None and len(every.leading) <= _LONGEST_POTENTIAL:
            found.append(sentence(Prose(f"That coefficient of S is {every.leading}")))
        if every.telescopes and every.order is not None:
            found.append(Markup("Along an orbit it telescopes: it is a Lie derivative."))
        return Markup(" ").join(found)
    if every.formula:
        found.append(sentence(Prose("It is ", Formula(every.formula))))
    if every.telescopes:
        by = "D" if every.timed else "X"
        found.append(Markup("Along an orbit it telescopes, for it is {}·G with").format(by))
        if every.potential and len(every.potential) < _LONGEST_POTENTIAL:
            found.append(prose(Prose("G = ", Formula(every.potential))) + ":")
        found.append(sentence(every.why))
    elif every.telescopes is False:
        found.append(Markup("It does not telescope: {}").format(sentence(every.why)))
    return Markup(" ").join(found)


SECTION = Section(order=20, view=_view)
