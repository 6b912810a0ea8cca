"""Certificates of proofs: the polynomials and the identities between them, as JSON.

A polynomial is a list of terms `[coefficient, name, name, …]`, a name once for each power, and a
number is a text such as "-3/2".
- `format`: what this is, with its version (see `verify.formats`).
- `hamiltonian`: a polynomial, or "every": then the names are p, q and H_p, H_q, H_pp, … as free
  derivatives of H (`separable`: the mixed ones are 0).
- `time_dependent`: true where H depends on t, and else not there. Then t is a name, H_pt, H_qtt, …
  are derivatives of H, and D = ∂_t + X takes the place of X.
- `parameters`: the names of H's parameters, for one H.
- `functions`: `[name, kind, argument]`, kind one of sin, cos, exp, inverse, inner ones first, for
  one H; a sin and the cos of the same argument stand together.
- `p_next`, `q_next`: the coefficients of h⁰, h¹, … of the map, as far as they are needed.
- `convergence_order` c: those of h⁰ … h^c are (Xⁿp)/n! and (Xⁿq)/n!, by X = H_p ∂_q − H_q ∂_p.
- `order` r and `leading`: the coefficients of h … h^(r−1) in det J vanish, that of h^r is
  `leading`, not zero. null: all vanish, and `leading` has no term.
- `witness`: for one H, a point at which `leading` and all denominators are other than 0.
- `potential` G, where it is there: X·G = `leading`.
- `cofactors`: what has to be zero is Σ cofactor·relation over the functions' relations.
- `stages`, alone with `hamiltonian`, `separable`, `time_dependent`, `degrees` and `numbers`: rows
  (kick, drift, share of p', share of q') of a scheme that is p' = p − h·kick·H_q,
  q' = q + h·drift·H_p, with H_p and H_q taken at those shares of the way from (p, q) to (p', q'):
  det J = 1. Where H depends on t a row has a fifth number c: both are taken at t + c h.
- `tableau`, as alone: an object of a Runge–Kutta method's `a`, a list of rows a_ij, and `b`, and
  where H depends on t of `c`, the stages' times: det J = 1.
- `numbers`, where the scheme's coefficients are irrational: `[name, polynomial, low, high]`, real
  numbers, each the one root of a polynomial between two rational ends. The polynomial is the list
  of its coefficients c₀, c₁, …, whole numbers. A coefficient of `stages` or `tableau` is a number,
  or a polynomial in these names.

In n degrees of freedom: `degrees` n; `next` has the coefficients of each coordinate's new value, by
its name; `leading` and `potential` are 2-forms, lists of [coordinate, coordinate, polynomial]. What
has to be zero is called `p1 0`, `S 3 p1 q2`, `potential p1 q2`.

`verify.proof.certificates.checker` recomputes derivatives, flow and determinant from these alone.
"""

from verify.errors import InputError
from verify.hamiltonians.coordinates import coordinates_in
from verify.proof.certificates.by_coefficients import write_coefficients
from verify.proof.certificates.file import FORMAT, Certificate
from verify.proof.certificates.statement import Statement, degrees_of, entries_of, layout_of
from verify.proof.every_by_series import series_in_jets
from verify.proof.every_proof import EveryProof
from verify.schemes import get
from verify.schemes.conditions.every_hamiltonian import BySeries
from verify.verdict import Verdict

_NOT_COVERED = "the checker knows coefficients of what preserves area, and Taylor polynomials"


def certify_every(proof: EveryProof) -> Certificate:
    """Write the certificate of a proof for every H; InputError where nothing is proved."""
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
    # Coefficients are the shorter certificate, and suffice where the scheme preserves the
    # structure.
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
