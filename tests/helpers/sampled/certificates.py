"""Drawn certificates of proofs, and whether what is printed of one is true."""

import json
from dataclasses import asdict
from typing import Any

from hypothesis import strategies as st

from tests.helpers.sampled.formulas import polynomials, rationals
from tests.oracle.printed_certificates import is_true
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.certificates.certification import certify_for_every_h, certify_for_one_h
from verify.proof.certificates.checker import check
from verify.proof.certificates.established_statement import state_theorem
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.order_for_one_h import prove
from verify.proof.plane.potential import potential_of
from verify.schemes import get

INVOLVED = (
    "cos({})",
    "sin({})",
    "exp({})",
    "1/(2 + ({})**2)",
    "exp(sin({}))",
    "cos({0})*sin({0})",
    "d*{}",
    "(1 + cos(2*t)/3)*{}",
    "sin({} - t)",
    "{}/(2 + t**2)",
)
EVERY = (
    "lie1",
    "lie2",
    "lie3",
    "symplectic-euler",
    "stormer-verlet",
    "implicit-midpoint",
    "ruth3",
    "implicit-symplectic-euler",
    "explicit-midpoint",
    "mclachlan-atela2",
    "gauss4",
)
IN_TIME = ("lie1", "lie2", "lie3", "stormer-verlet", "implicit-midpoint", "ruth3", "forest-ruth")
Data = dict[str, Any]


def as_read(data: Data) -> Data:
    return json.loads(json.dumps(data))  # type: ignore[no-any-return]


def of_text(text: str, name: str) -> Data:
    """The certificate of the scheme of that name for this H."""
    scheme = get(name)
    proof = prove(scheme.step_map(Hamiltonian.parse(text)), scheme)
    return as_read(certify_for_one_h(proof, potential_of(proof, scheme)))


def of_every_in_time(name: str) -> Data:
    """That of the scheme for every H(p, q, t)."""
    return as_read(certify_for_every_h(prove_for_every_h(name, timed=True)))


@st.composite
def of_drawn(draw: st.DrawFn) -> Data:
    """The certificate of a drawn H, separable for a half of them, and a scheme."""
    separable = draw(st.booleans())
    inner = draw(polynomials("q" if separable else "pq", degree=2, most_terms=2))
    bent = draw(st.sampled_from(INVOLVED)).format(f"({inner})")
    text = f"p**2/2 + ({draw(rationals(4))})*{bent} + ({draw(rationals(3))})*q**3 + 5"
    scheme = get(draw(st.sampled_from(["lie1", "lie2", *["symplectic-euler"] * separable])))
    proof = prove(scheme.step_map(Hamiltonian.parse(text)), scheme)
    potential = potential_of(proof, scheme)
    data = as_read(certify_for_one_h(proof, potential))
    assert (data["order"], data["convergence_order"]) == (proof.order, proof.convergence_order)
    assert all(data.get("cofactors", {}).values()), "what is zero as it stands has none"
    assert ("potential" in data) == (potential.potential is not None and proof.order is not None)
    needed = max(proof.order or 0, proof.convergence_order or 0) + 1
    assert proof.order is None or max(map(len, (data["p_next"], data["q_next"]))) <= needed
    return data


certificates = st.one_of(
    of_drawn(),
    of_drawn(),
    st.sampled_from(EVERY).map(lambda name: as_read(certify_for_every_h(prove_for_every_h(name)))),
    st.sampled_from(IN_TIME).map(of_every_in_time),
)


def true(data: Data) -> bool:
    """Whether what is printed of an accepted certificate holds, as far as a point shows it."""
    return is_true(asdict(state_theorem(check(data))), points=1)
