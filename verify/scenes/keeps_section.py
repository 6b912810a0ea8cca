"""The section of a scene on what a step is meant to keep, and the reader of what it names.

keeps = ["volume", "energy: 3"]        # kept exactly; but for O(h^3) in one step

[keeps]                                # the same, with what refines a structure and implies it
structures = ["energy: 3", "q1*p2 - q2*p1"]
form = "m1*dv1^dx1 + m2*dv2^dx2"       # the 2-form of symplectic
density = "1/(u*v)"                    # of volume
poisson = "0, u*v; -u*v, 0"            # the matrix of the bracket
casimirs = ["x**2 + y**2 + z**2"]      # of the bracket
reverses = "-v, x"                     # the involution of reversible
factor = "exp(-gamma*h)"               # of conformal
"""

import re
from collections.abc import Sequence
from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.frozen import Frozen
from verify.scenes.observables import carries
from verify.structures import Structure
from verify.structures.first_integral import FirstIntegral
from verify.structures.reading import ClaimedStructure, KeepsRequest, read_structures

_MOST = 100
Texts = Annotated[tuple[str, ...], Field(max_length=_MOST)]


class Refinements(Frozen):
    """The keys that refine structures, in scenes and in claims."""

    form: str = ""
    """The 2-form of `symplectic` or `conformal`, such as `du^dv/(u*v)`."""
    density: str = ""
    """The density of `volume`; 1 where it is left out."""
    poisson: str = ""
    """The matrix of the bracket of `poisson`: rows by `;`, entries by `,`."""
    casimirs: Texts = ()
    """Casimirs of the bracket, which are to be kept too."""
    reverses: str = ""
    """The involution of `reversible`, such as `-v, x`; p to −p where it is left out."""
    factor: str = ""
    """The factor of the form in one step, of `conformal`, such as `exp(-gamma*h)`."""

    def request(self, *keeps: str) -> KeepsRequest:
        """Return the request of these structures, refined so."""
        return KeepsRequest(keeps, **{name: getattr(self, name) for name in REFINEMENTS})


REFINEMENTS = tuple(Refinements.model_fields)
_OPTION = re.compile(rf"--(keeps|casimir|{'|'.join(REFINEMENTS)})\b")


# No `Section`: those are of runs, for which every parameter needs a value.
class Keeps(Refinements):
    """The structures that a step is meant to keep; see the module's text."""

    structures: Texts = ()
    """Names (`area` `symplectic` `volume` `energy` `momentum` `angular-momentum` `reversible`
    `symmetric` `conformal` `poisson`) or formulas of first integrals; with `: k` behind one, its
    defect in one step is meant to be O(h^k), and else 0."""

    @model_validator(mode="before")
    @classmethod
    def _read_list(cls, data: Any) -> Any:
        if isinstance(data, str):
            data = (data,)
        return {"structures": data} if isinstance(data, list | tuple) else data

    @model_validator(mode="after")
    def _check(self) -> Self:
        if not self.request(*self.structures):
            raise InputError("keeps", NOT_GIVEN, "names nothing that is kept")
        return self

    def observables(self, system: Hamiltonian) -> tuple[str, ...]:
        """Return the observables of runs in which defects of these structures accumulate."""
        claims = read_structures(self.request(*self.structures), system)
        names = (observable_of(claim.structure, system) for claim in claims)
        return tuple(dict.fromkeys(filter(None, names)))

    def claims(self, system: Hamiltonian, prefix: str = "") -> Sequence[ClaimedStructure]:
        """Return what is claimed to be kept; see `read_claims`."""
        return read_claims(self.request(*self.structures), system, prefix)


def read_claims(
    request: KeepsRequest, system: Hamiltonian, prefix: str = ""
) -> Sequence[ClaimedStructure]:
    """Return the requested structures, each of which the exact flow keeps.

    Raises InputError, which names a key, behind the `prefix`, where the command has an option.
    """
    from verify.proof.structures.structure_order import check_structure

    try:
        claims = read_structures(request, system)
        for claim in claims:
            check_structure(system, claim.structure.with_values(system.value_substitutions))
    except InputError as error:
        raise name_keys(error, prefix) from None
    return claims


def name_keys(error: InputError, prefix: str = "") -> InputError:
    """Return the error with names of keys in place of options; see `read_claims`."""
    name, problem = (_with_keys(text) for text in (error.name, error.problem))
    place = name if name == "keeps" else prefix + name
    return type(error)(place, error.value, problem)


def observable_of(structure: Structure, system: Hamiltonian) -> str:
    """Return the observable of runs in which the defect accumulates; "" if there is none."""
    values = structure.with_values(system.value_substitutions)
    at_end, *largest = values.observables(system.coordinates)
    # Of a function that oscillates the greatest change is shown.
    name = largest[0] if isinstance(structure, FirstIntegral) else at_end
    return name if carries(system, name) else ""


def _with_keys(text: str) -> str:
    """Return a message with the names of keys in place of options."""
    return _OPTION.sub(lambda match: "casimirs" if match[1] == "casimir" else match[1], text)
