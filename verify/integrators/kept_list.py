"""The list of what a step or map keeps, for whoever asks nothing: by a few cheap readings.

The symplectic form and volume are those of the finding; energy, and reversibility by p ↦ −p, are
measured at two places. The list changes no verdict.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from verify.algebra.formula import symbol
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.kept_measurement import KeptSurvey
from verify.integrators.measures.probes import probe_of
from verify.integrators.places.trial_places import TrialPlace, select_spread
from verify.integrators.results import Finding, KeptStructure
from verify.integrators.user_code.step import unless_it_fails
from verify.integrators.user_code.user_map import UserMap
from verify.prose import Prose, read_prose
from verify.structures import Structure, structure_in
from verify.structures.first_integral import FirstIntegral
from verify.structures.reversible import Reversible
from verify.structures.volume import Volume
from verify.verdict import Verdict

_MOST_PLACES = 2
_DIVISORS = tuple(map(Fraction, (4, 16, 32, 64, 128, 256)))  # of a place's largest step
_SHARE_OF_TIME = 0.5  # that has to be left


def add_list(
    finding: Finding, step: UserMap, system: Hamiltonian | None, places: Sequence[TrialPlace]
) -> Finding:
    """Return the finding with the list, and a note that says it in words."""
    if finding.how == "calls" or step.seconds_left < _SHARE_OF_TIME * step.limit:
        return finding
    keeps = [*_from_finding(finding), *_measure(finding, step, system, places)]
    text = _describe(keeps)
    return replace(finding, keeps=tuple(keeps)).noting(*([text] if text else []))


def _from_finding(finding: Finding) -> list[KeptStructure]:
    """Return the symplectic form, and volume in several degrees of freedom."""
    form = structure_in(finding.degrees)
    order = finding.order if not finding.symplectic else None
    volume = Volume("volume", "volume", symbol("h") ** 0)
    entries = [_entry(form, finding.how, finding.symplectic, order)]
    if finding.degrees > 1:
        entries.append(_entry(volume, finding.how, finding.area_preserving, None))
    return entries


def _entry(structure: Structure, how: str, exact: bool | None, order: int | None) -> KeptStructure:
    text = {True: "is 0", False: "is not 0", None: "may be 0"}[exact]
    text = f"`{structure.defect_formula}` {text}" + (f", but O(`h^{order}`)" if order else "")
    kept_verdict = Verdict.PROVED if how == "proof" else Verdict.MEASURED
    verdict = kept_verdict if exact else None
    return KeptStructure(structure, verdict, read_prose(text), how, exact=exact, order=order)


def _measure(
    finding: Finding, step: UserMap, system: Hamiltonian | None, places: Sequence[TrialPlace]
) -> list[KeptStructure]:
    structures = list(_structures(step, system))
    how = "floats" if step.foreign or finding.how == "floats" else "duals"
    probe = unless_it_fails(lambda: probe_of(step, how)) if structures else None
    if probe is None:
        return []
    survey = KeptSurvey(probe, select_spread(places, _MOST_PLACES))
    keeps = []
    for structure in structures:
        measurement = survey.follow(structure, survey.places, _DIVISORS)
        vanishes = measurement.vanishes
        power = None if vanishes else measurement.power
        if vanishes is not None and (vanishes or power or isinstance(structure, Reversible)):
            keeps.append(_entry(structure, how, vanishes, power))
    return keeps


def _structures(step: UserMap, system: Hamiltonian | None) -> list[Structure]:
    """Return energy and reversibility, as far as the system may have them."""
    if step.time_dependent or (system is not None and system.energy is None):
        return []
    momenta = {symbol(name): -symbol(name) for name in step.names[: step.degrees]}
    turned = tuple(momenta.get(symbol(name), symbol(name)) for name in step.names)
    reversible = Reversible("reversible", "reversible by p ↦ −p", turned)
    if system is None:
        return [reversible]
    energy = FirstIntegral("energy", "energy", system.exact)
    is_even = system.exact.xreplace(momenta) == system.exact
    return [reversible, energy] if is_even else [energy]


def _describe(keeps: Sequence[KeptStructure]) -> Prose | None:
    """Return the list in words."""
    by_name = {x.structure.name: x for x in keeps}
    texts = []
    form = by_name.get("area") or by_name.get("symplectic")
    volume = by_name.get("volume")
    if form is not None and form.exact:
        texts.append("area (det J = 1)" if volume is None else "the symplectic form")
    elif form is not None and form.exact is False and volume is not None and volume.exact:
        texts.append("volume (det J = 1), not the symplectic form")
    elif form is not None and form.order:
        texts.append(f"{form.structure.label} to `h^{form.order - 1}`")
    energy, reversible = by_name.get("energy"), by_name.get("reversible")
    if energy is not None:
        texts.append("energy" if energy.exact else f"energy to `h^{(energy.order or 1) - 1}`")
    sentence = f"keeps {', '.join(texts)}" if texts else ""
    if reversible is not None:
        word = "reversible by p ↦ −p"
        sentence += f"; {word}" if reversible.exact else f"; not {word}"
    return read_prose(sentence.removeprefix("; ")) if sentence else None
