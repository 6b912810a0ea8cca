"""Certificates of proofs in n degrees of freedom; the format is told in `every`.

What differs: `degrees` n; `next` has the coefficients of each coordinate's new value, by its name;
`leading` and `potential` are 2-forms, lists of [coordinate, coordinate, polynomial]. What has to be
zero is called `p1 0`, `S 3 p1 q2`, `potential p1 q2`.
"""

import math
from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import combinations
from typing import Any

from verify.algebra.ring import Poly
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.certificates.by_coefficients import by_coefficients, terms
from verify.proof.certificates.every import NOT_KNOWN
from verify.proof.certificates.file import FORMAT, Certificate
from verify.proof.certificates.one import Plain, witness_of
from verify.proof.symplectic.defect import DefectSeries
from verify.proof.symplectic.defect import series_of as series_of_defect
from verify.proof.symplectic.every import JetFlow
from verify.proof.symplectic.proof import SymplecticProof
from verify.proof.symplectic.telescoping import potential_of_lie
from verify.proof.symplectic.two_form import TwoForm
from verify.schemes.degrees import kind_of, map_in_degrees
from verify.schemes.degrees.canonical_map import State, series_of
from verify.schemes.every_hamiltonian import TaylorSeries
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict

_NOTHING = "there is nothing to certify"
Names = Mapping[int, str]


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
    defect = series_of_defect(step, most)
    field, rows = defect.flow, [defect.coefficient(n) for n in range(most + 1)]
    plain = Plain(field.ring, field.names)
    leading = None if proof.order is None else defect.form(proof.order)
    eta = step.flow_up_to
    has_potential = proof.telescopes and eta > 0 and eta % 2 == 0  # of odd η S ≡ 0 does, without
    potential = potential_of_lie(field, eta) if has_potential else None
    columns = [[row[k] for row in rows] for k in range(len(field.names))]
    data = {
        "format": FORMAT,
        "degrees": proof.degrees,
        "hamiltonian": terms(plain.without_constants(field.energy), plain.names),
        **({"time_dependent": True} if field.timed else {}),
        "parameters": [n for n in field.ring.variables if n not in (*field.names, "h", "t")],
        "functions": plain.functions,
        **_map(proof, field.names, columns, leading, potential, plain.names),
        "cofactors": {},
    }
    data["witness"] = witness_of(data, field.names, proof.witness)
    zeros = _zeros(plain, data, field.energy, columns, leading, potential)
    data["cofactors"] = {what: plain.cofactors(x) for what, x in zeros if not x.is_zero()}
    return data


def of_every_in_degrees(
    proof: SymplecticProof, scheme: Scheme, *, separable: bool, timed: bool
) -> Certificate:
    """The certificate of a proof for every H. Raises InputError where there is none."""
    every_h = scheme.every_h
    if proof.verdict is not Verdict.PROVED or every_h is None:
        raise InputError("scheme", scheme.name, f"{proof.verdict}: {_NOTHING}")
    data: Certificate = {
        "format": FORMAT,
        "degrees": proof.degrees,
        "hamiltonian": "every",
        "separable": separable or scheme.needs_separable,
        **({"time_dependent": True} if timed else {}),
    }
    given = by_coefficients(scheme, timed=timed) if proof.symplectic else None
    if given is not None:
        return data | given
    kind = kind_of(scheme)
    if proof.order is None or proof.convergence_order is None or not hasattr(kind, "step"):
        raise InputError("scheme", scheme.name, NOT_KNOWN)
    flow = JetFlow(proof.degrees, proof.order + 2, separable=data["separable"], timed=timed)
    state: State = series_of(flow, kind.step(every_h), proof.order)
    columns = [list(series.coefficients) for series in state]
    leading = DefectSeries(lambda _: (flow, state), proof.order).form(proof.order)
    potential = None
    if isinstance(every_h, TaylorSeries) and proof.telescopes:
        potential = potential_of_lie(flow, every_h.eta)
    names = dict(enumerate(flow.ring.context.names()))
    return data | _map(proof, flow.names, columns, leading, potential, names)


def _map(
    proof: SymplecticProof,
    coordinates: tuple[str, ...],
    rows: list[list[Poly]],
    leading: TwoForm | None,
    potential: TwoForm | None,
    names: Names,
) -> dict[str, Any]:
    after = {
        name: [terms(x, names) for x in row] for name, row in zip(coordinates, rows, strict=True)
    }
    beside = {} if potential is None else {"potential": _form(potential, names)}
    return {
        "order": proof.order,
        "convergence_order": proof.convergence_order,
        "leading": [] if leading is None or proof.order is None else _form(leading, names),
        "next": after,
        **beside,
    }


def _form(form: TwoForm, names: Names) -> list[list[Any]]:
    return [[form.names[a], form.names[b], terms(x, names)] for (a, b), x in form.entries.items()]


def _zeros(
    plain: Plain,
    data: Certificate,
    energy: Poly,
    rows: list[list[Poly]],
    leading: TwoForm | None,
    potential: TwoForm | None,
) -> Iterator[tuple[str, Poly]]:
    """What has to be zero, each by its name in the checker's words."""
    ring, names = plain.ring, plain.coordinates
    n, size, order = len(names) // 2, len(names), data["order"]
    zero = ring.zero
    first = [plain.diff(energy, name) for name in names]
    slopes = [-x for x in first[n:]] + first[:n]

    def along(y: Poly) -> Poly:
        total = plain.diff(y, "t") if "t" in plain.variables else zero
        for slope, name in zip(slopes, names, strict=True):
            total += slope * plain.diff(y, name)
        return total

    for name, row in zip(names, rows, strict=True):
        flow = ring.variable(name)
        for k in range(data["convergence_order"] + 1):
            own = row[k] if k < len(row) else zero
            yield f"{name} {k}", own - flow * ring.constant(Fraction(1, math.factorial(k)))
            flow = along(flow)
    gradients = [[[plain.diff(x, by) for by in names] for x in row] for row in rows]
    last = order or 2 * max(map(len, rows))
    for m in range(1, last + 1):
        for a, b in combinations(range(size), 2):
            gap = -leading.at(a, b) if leading is not None and m == order else zero
            for i in range(n):
                p, q = gradients[i], gradients[n + i]
                for k in range(max(0, m - len(q) + 1), min(m + 1, len(p))):
                    gap += p[k][a] * q[m - k][b] - p[k][b] * q[m - k][a]
            yield f"S {m} {names[a]} {names[b]}", gap
    if potential is not None and leading is not None:
        for a, b in combinations(range(size), 2):
            gap = along(potential.at(a, b)) - leading.at(a, b)
            for c, slope in enumerate(slopes):
                gap += plain.diff(slope, names[a]) * potential.at(c, b)
                gap += potential.at(a, c) * plain.diff(slope, names[b])
            yield f"potential {names[a]} {names[b]}", gap
