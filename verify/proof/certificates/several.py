"""Certificates of proofs in n degrees of freedom; the format is told in `every`.

What differs: `degrees` n; `next` has the coefficients of each coordinate's new value, by its name;
`leading` and `potential` are 2-forms, lists of [coordinate, coordinate, polynomial]. What has to be
zero is called `p1 0`, `S 3 p1 q2`, `potential p1 q2`.
"""

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.certificates.file import Certificate
from verify.proof.certificates.plain import Plain
from verify.proof.certificates.statement import Statement, certificate_of_one, entries_of
from verify.proof.expansion import series_of
from verify.proof.symplectic.proof import SymplecticProof
from verify.proof.telescoping import potential_of_lie
from verify.schemes.degrees import map_in_degrees
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict

_NOTHING = "there is nothing to certify"


def of_one_in_degrees(
    proof: SymplecticProof, hamiltonian: Hamiltonian, scheme: Scheme
) -> Certificate:
    """The certificate of a proof for one H.

    Raises InputError where nothing is proved, where the map is no polynomial in h that is written
    out, and where H needs other functions than sin, cos, exp and denominators.
    """
    agreed = proof.convergence_order
    if proof.verdict is not Verdict.PROVED or agreed is None or agreed < 0:
        raise InputError("proof", proof.verdict.value, _NOTHING)
    step = map_in_degrees(scheme, hamiltonian)
    most = max(proof.order or 0, agreed)
    if proof.order is None:
        if step.degree is None:
            raise InputError("map", scheme.name, "is not written out as a polynomial in h")
        most = step.degree
    defect = series_of(step, most)
    field, rows = defect.flow, [defect.coefficient(n) for n in range(most + 1)]
    plain = Plain(field.ring, field.names)
    leading = None if proof.order is None else defect.form(proof.order)
    eta = step.flow_up_to
    has_potential = proof.telescopes and eta > 0 and eta % 2 == 0  # of odd η S ≡ 0 does, without
    potential = potential_of_lie(field, eta) if has_potential else None
    columns = [[row[k] for row in rows] for k in range(len(field.names))]
    statement = Statement(
        field.names,
        columns,
        proof.order,
        agreed,
        entries_of(leading),
        None if potential is None else entries_of(potential),
    )
    return certificate_of_one(statement, plain, field.energy, proof.witness)
