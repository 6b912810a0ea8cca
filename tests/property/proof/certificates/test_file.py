"""What has a certificate: a proof and nothing less, and nested as deep as a checker can look."""

import json
import sys
import tempfile
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.constructed.schemes import made_of, proof_of
from tests.helpers.sampled.certificates import EVERY, Data, as_read
from tests.helpers.sampled.formulas import rationals
from verify.errors import InputError
from verify.proof.certificates import certification as certificate
from verify.proof.certificates.certificate_file import FORMAT, check_file
from verify.proof.certificates.certification import certify_for_every_h
from verify.proof.certificates.checker import check
from verify.proof.certificates.established_statement import EstablishedStatement, state_theorem
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.schemes.conditions.every_hamiltonian import RungeKutta
from verify.verdict import Verdict

OF_ONE_H = "p_next = p - h*q; q_next = q + h*p_next"
proofs = cache(prove_for_every_h)
names = st.sampled_from(EVERY)
verdicts = st.sampled_from([Verdict.PROVED, *Verdict])
quick = drawn(40)


def refused(proof: ProofForEveryH) -> str:
    with pytest.raises(InputError) as found:
        certify_for_every_h(proof)
    return str(found.value)


@quick
@given(names, verdicts, st.booleans(), st.booleans())
def test_what_is_not_proved_for_every_h_has_no_certificate(
    name: str, verdict: Verdict, of_every_h: bool, ordered: bool
) -> None:
    """Nor has a map whose order is not told, or that is a scheme for one H."""
    proof = replace(
        proofs(name),
        verdict=verdict,
        scheme=name if of_every_h else OF_ONE_H,
        convergence_order=proofs(name).convergence_order if ordered else None,
    )
    if verdict is Verdict.PROVED and of_every_h and ordered:
        data = as_read(certify_for_every_h(proof))
        said = state_theorem(check(data))
        assert data["format"] == FORMAT
        assert ("potential" in data) == bool(proof.telescopes)
        assert ("T(p) + V(q)" in said.hamiltonian) == proof.separable
    else:
        assert f"{verdict}: there is nothing to certify" in refused(proof)


@drawn(15)
@given(rationals(4), st.booleans())
def test_two_explicit_stages_of_order_2_have_a_potential_that_is_certified(
    alpha: Fraction, separable: bool
) -> None:
    """L = X·G, G = (1 − α)/2 det Hess H, α the second node; it is 0 for Heun's, α = 1."""
    generic = RungeKutta(((), (alpha,)), (1 - 1 / (2 * alpha), 1 / (2 * alpha)))
    proof = proof_of(generic, 2, separable=separable)
    assert (proof.verdict, proof.convergence_order) == (Verdict.PROVED, 2)
    assert (proof.order, proof.telescopes) == ((4, False) if alpha == 1 else (3, True))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(certificate, "get", lambda _: made_of(generic, 2))
        data = as_read(certify_for_every_h(proof))
    said = state_theorem(check(data))
    assert ("T(p) + V(q)" in said.hamiltonian) == separable
    if alpha == 1:
        assert "potential" not in data
        return
    size = (1 - alpha) / 2
    wanted = [[str(size), "H_pp", "H_qq"], *[[str(-size), "H_pq", "H_pq"]] * (not separable)]
    assert sorted(data["potential"]) == sorted(wanted)
    data["potential"][0][0] = str(-size * 2)
    with pytest.raises(ValueError, match="potential is not zero"):
        check(data)


def fraction_of(depth: int, first: int) -> Data:
    """q' = q + h q e_n, e_n = 1/(1 + e_(n−1)) a continued fraction: ΔJ = h e_n, not zero."""
    functions: list[list[object]] = [["#0", "inverse", [[str(first)]]]]
    functions += [[f"#{k}", "inverse", [["1"], ["1", f"#{k - 1}"]]] for k in range(1, depth + 1)]
    return {
        "format": FORMAT,
        "hamiltonian": [["1/2", "p", "p"]],
        "parameters": [],
        "functions": functions,
        "p_next": [[["1", "p"]]],
        "q_next": [[["1", "q"]], [["1", "q", f"#{depth}"]]],
        "convergence_order": 0,
        "order": 1,
        "leading": [["1", f"#{depth}"]],
        "witness": {"p": "1", "q": "1"},
        "cofactors": {},
    }


@drawn(6)
@given(st.integers(0, 30), st.booleans(), st.integers(1, 9), st.integers(1, 4))
def test_a_certificate_that_is_nested_deeply_is_checked_or_refused_in_words(
    depth: int, beyond: bool, first: int, times: int
) -> None:
    depth += sys.getrecursionlimit() * beyond
    data = fraction_of(depth, first)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "certificate.json"
        path.write_text(json.dumps(data), encoding="utf-8")
        found = check_file(path)
        assert beyond or (isinstance(found, EstablishedStatement) and found.order == 1)
        assert isinstance(found, EstablishedStatement) or "too l" in found
        data["leading"][0][0] = str(Fraction(times + 1, times))
        path.write_text(json.dumps(data), encoding="utf-8")
        assert isinstance(check_file(path), str), "another leading coefficient is none"
        path.write_text("[" * (depth * 100), encoding="utf-8")
        with pytest.raises(InputError):
            check_file(path)
