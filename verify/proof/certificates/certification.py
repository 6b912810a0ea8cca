"""Certificates of proofs, for every H and for one: polynomials and their identities, as JSON.

A polynomial is a list of terms `[coefficient, name, name, …]`, in which a name stands once for each
power. A number is a text such as "-3/2". J is the Jacobian of the map, X the derivative along the
flow.
- `format`: the name of the format with its version (see `verify.formats`).
- `hamiltonian`: a polynomial, or "every": then the names are p, q and H_p, H_q, H_pp, … as free
  derivatives of H (`separable`: the mixed ones are 0).
- `time_dependent`: true if H depends on t, else left out. If true, t is a name, H_pt, H_qtt, … are
  derivatives of H, and D = ∂_t + X takes the place of X.
- `parameters`: the names of H's parameters, for one H.
- `functions`: for one H, `[name, kind, argument]` with the kind sin, cos, exp or inverse, inner
  functions first; with a sin there is the cos of the same argument, and with a cos the sin.
- `p_next`, `q_next`: the coefficients of h⁰, h¹, … in the map, as far as they are needed.
- `convergence_order` c: for n = 0 … c, the coefficients of hⁿ are (Xⁿp)/n! and (Xⁿq)/n! with
  X = H_p ∂_q − H_q ∂_p.
- `order` r and `leading`: the coefficients of h … h^(r−1) in det J vanish, and that of h^r is
  `leading` ≠ 0. If `order` is null, all vanish, and `leading` has no term.
- `witness`: for one H, a point at which `leading` and all denominators are other than 0.
- `potential` G, which may be left out: X·G = `leading`.
- `cofactors`: for one H, by the name of an identity: its residual, which must be zero, is
  Σ cofactor·relation over the functions' relations.
- `stages`, only with `hamiltonian`, `separable`, `time_dependent`, `degrees` and `numbers`: rows
  (kick, drift, share of p', share of q') of a scheme p' = p − h·kick·H_q, q' = q + h·drift·H_p, in
  which H_p and H_q are taken at these shares of the way from (p, q) to (p', q'). The statement is
  det J = 1. If H depends on t, a row has a fifth number c: both are taken at t + c h.
- `tableau`, only with the same keys: the `a`, a list of rows a_ij, and `b` of a Runge–Kutta method,
  and if H depends on t also `c`, the stages' times. The statement is det J = 1.
- `numbers`, if the scheme's coefficients are irrational: `[name, polynomial, low, high]`, real
  numbers, each the only root of a polynomial between two rational ends. The polynomial is the list
  of its coefficients c₀, c₁, …, whole numbers. A coefficient in `stages` or `tableau` is a number,
  or a polynomial in these names.

In n degrees of freedom `degrees` is n, and S = JᵀΩJ − Ω takes the place of det J − 1. `next` has
the coefficients of each coordinate's new value, by name; `leading` and `potential` are 2-forms,
lists of [coordinate, coordinate, polynomial]. The identities are called `p1 0`, `S 3 p1 q2`,
`potential p1 q2`.

`verify.proof.certificates.checker` recomputes derivatives, flow and determinant from these alone.
"""

import sympy

from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field, require_canonical
from verify.hamiltonians.coordinates import PLANE, coordinates_in
from verify.proof.certificates.certificate_file import FORMAT, Certificate
from verify.proof.certificates.coefficient_entries import write_coefficients
from verify.proof.certificates.map_statement import (
    Form,
    Statement,
    certificate_for_one_h,
    degrees_of,
    entries_of,
    layout_of,
    without_constants,
)
from verify.proof.expansion import ClosedSeries, series_of
from verify.proof.plane.potential import Potential
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.proof.proof_for_one_h import Proof
from verify.proof.series_for_every_h import series_in_jets
from verify.proof.telescoping import potential_of_lie
from verify.schemes import get
from verify.schemes.conditions.every_hamiltonian import BySeries
from verify.structures import AREA, SYMPLECTIC
from verify.verdict import Verdict

_NOT_COVERED = "the checker knows coefficients of what preserves area, and Taylor polynomials"


# -- for every H ----------------------------------------------------------------------------------


def certify_for_every_h(proof: ProofForEveryH) -> Certificate:
    """Return the certificate of a proof for every H; InputError if nothing is proved."""
    scheme, agreed = get(proof.scheme), proof.convergence_order
    every_h = scheme.every_h
    if proof.verdict is not Verdict.PROVED or every_h is None or agreed is None:
        raise InputError("scheme", proof.scheme, f"{proof.verdict}: there is nothing to certify")
    layout = layout_of(coordinates_in(proof.degrees))
    data: Certificate = {
        "format": FORMAT,
        **degrees_of(layout),
        "hamiltonian": "every",
        "separable": proof.separable,
        **({"time_dependent": True} if proof.timed else {}),
    }
    # A certificate by coefficients is shorter, and suffices if the scheme preserves the structure.
    coefficients = write_coefficients(scheme, timed=proof.timed) if proof.symplectic else None
    if coefficients is not None:
        return data | coefficients
    if proof.order is None or proof.form is None or not isinstance(every_h, BySeries):
        raise InputError("scheme", proof.scheme, _NOT_COVERED)
    series, potential = series_in_jets(proof, every_h, proof.order), proof.potential_form
    flow, powers = series.flow, range(proof.order + 1)
    statement = Statement(
        layout,
        list(zip(*map(series.coefficient, powers), strict=True)),
        proof.order,
        agreed,
        entries_of(proof.form),
        None if potential is None else entries_of(potential),
    )
    return data | statement.entries(dict(enumerate(flow.ring.context.names())))


# -- for one H ------------------------------------------------------------------------------------


def certify_for_one_h(proof: Proof, potential: Potential | None = None) -> Certificate:
    """Return the certificate of a proof for one H.

    `potential`: the potential of ΔJ's leading coefficient, in the plane. Raises InputError if
    nothing is proved, if the map has no closed form that is a polynomial in h, and if H has other
    functions than sin, cos, exp and denominators.
    """
    if proof.verdict is not Verdict.PROVED or proof.convergence_order is None:
        raise InputError("proof", proof.verdict.value, "there is nothing to certify")
    make = {AREA: _in_plane, SYMPLECTIC: _in_degrees}[proof.structure]
    field, statement = make(proof, potential or Potential(None, ""))
    return certificate_for_one_h(statement, field, proof.witness)


def _in_plane(proof: Proof, potential: Potential) -> tuple[CanonicalField, Statement]:
    step, order, agreed = proof.step_map, proof.order, proof.convergence_order or 0
    if step.flat.degree is None or (order is None) != (proof.area_preserving is True):
        raise InputError("map", str(step.p_next), "is no polynomial in h: no certificate")
    expressions = *step.composed, proof.leading, potential.potential or sympy.S.Zero
    field, (*after, leading, telescoping) = canonical_field(step.hamiltonian, *expressions)
    length = max(order, agreed) + 1 if order else None
    has_potential = order is not None and potential.potential is not None
    # X·c = 0 for a constant c, so that G is written without its constant term.
    without = without_constants(field.ring, telescoping, (*PLANE, "t"))
    return field, Statement(
        layout_of(field.names),
        [_coefficients(field.ring, x)[:length] for x in after],
        order,
        agreed,
        _form(leading),
        _form(without) if has_potential else None,
    )


def _in_degrees(proof: Proof, _: Potential) -> tuple[CanonicalField, Statement]:
    step, order, agreed = proof.step_map, proof.order, proof.convergence_order or 0
    last_power: int | None = max(order or 0, agreed)
    if order is None:
        last_power = step.closed.degree if step.formulas is not None and step.closed else None
    if last_power is None:
        formula = step.hamiltonian.formula
        raise InputError("map", formula, "is not written out as a polynomial in h")
    form = None if order is None else proof.first.form
    series, entries = series_of(step, last_power), entries_of(form)
    if isinstance(series, ClosedSeries):
        # If h stands within a function, each coefficient has its own ring, and so has S.
        expressions = [form.ring.expression(x) for x in entries.values()] if form else []
        field, rows, elements = series.in_one_field(step.hamiltonian, last_power, *expressions)
        entries = dict(zip(entries, elements, strict=True))
    else:
        field, columns = series.flow, [series.coefficient(n) for n in range(last_power + 1)]
        rows = [list(row) for row in zip(*columns, strict=True)]
    eta = step.flow_up_to
    has_potential = proof.telescopes and eta > 0 and eta % 2 == 0  # for odd η there is none
    potential = entries_of(potential_of_lie(field, eta)) if has_potential else None
    names = layout_of(field.names)
    statement = Statement(names, rows, order, agreed, entries, potential)
    return require_canonical(field), statement


def _coefficients(ring: Ring, x: Poly) -> list[Poly]:
    """Return the coefficients of h⁰, h¹, … of a polynomial in h."""
    powers = ring.powers(x, "h")
    return [powers.get(n, ring.zero) for n in range(max(powers, default=0) + 1)]


def _form(x: Poly) -> Form:
    """Return x dp∧dq as a form."""
    return {} if x.is_zero() else {PLANE: x}
