"""Claims say where they hold: as written, at the stages, for which parameters."""

from fractions import Fraction
from typing import Any

import pytest

from verify.claims.base_claim import Findings
from verify.claims.kinds import models
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene

DUFFING = "p**2/2 + q**2/2 + delta*q**4/4"
HARMONIC = "p**2/2 + q**2/2"
LOG = "p**2/2 + log(q)"


def judged(hamiltonian: str, kind: str, scheme: str = "lie2", **keys: Any) -> ClaimResult:
    model = models()[kind]
    claim = model.model_validate(
        {"id": "c", "scene": "made", "scheme": scheme, "kind": kind, **keys}
    )
    made = Scene(hamiltonian=hamiltonian, schemes=(scheme,), name="made")
    return claim.judge(Findings({"made": made}))


EXACT = "h**4*(1 + 3*delta*q**2)**2/4"
MAP = {"q_next": "q + h*p - h**2/2*q"}


@pytest.mark.parametrize(
    ("formula", "verdict", "domain"),
    [
        (f"3*h**3*delta*p*q + {EXACT}", "PROVED", []),
        (f"3*h**3*delta*p*sqrt(q)**2 + {EXACT}", "PROVED", ["q >= 0"]),
        (f"3*h**3*delta*sqrt(p)*sqrt(p)*q + {EXACT}", "PROVED", ["p >= 0"]),
        (f"3*h**3*delta**2/delta*p*q + {EXACT}", "PROVED", ["delta != 0"]),
        (f"3*h**3*delta*p*sqrt(q)**2 + {EXACT} + h**9", "REFUTED", ["q >= 0"]),
        (f"3*h**3*delta*p*q + {EXACT} + 0*sqrt(q)*sqrt(-1 - q)", "UNDECIDED",
         ["-q - 1 >= 0", "q >= 0"]),
    ],
)  # fmt: skip
def test_a_formula_is_judged_where_it_is_defined(
    formula: str, verdict: str, domain: list[str]
) -> None:
    found = judged(DUFFING, "delta_j", formula=formula)
    assert (found.verdict, sorted(found.domain)) == (verdict, domain)
    assert ("where" in found.evidence) is (verdict == "PROVED" and bool(domain))


def test_a_map_is_judged_where_its_formulas_are_defined() -> None:
    found = judged(HARMONIC, "step_map", p_next="p - h*exp(log(q)) - h**2/2*p", **MAP)
    assert (found.verdict, found.domain) == ("PROVED", ("q > 0",))
    assert found.evidence.endswith("up to h^2, where q > 0")
    everywhere = judged(HARMONIC, "step_map", p_next="p - h*q - h**2/2*p", **MAP)
    assert (everywhere.verdict, everywhere.domain) == ("PROVED", ())


def test_a_witness_lies_where_the_formula_is_defined() -> None:
    found = judged(HARMONIC, "delta_j", formula="h**4/4 + h*sqrt(q - 3)**2")
    assert found.verdict == "REFUTED"
    at = found.evidence.partition("; at ")[2].partition(" it is")[0]
    point = dict(each.split(" = ") for each in at.split(", "))
    assert Fraction(point["q"]) > 3


@pytest.mark.parametrize(
    ("keys", "verdict", "domain"),
    [
        ({"order": 3}, "PROVED", ("delta != 0",)),
        ({"order": 3, "at_least": True}, "PROVED", ()),
        ({"order": 2}, "REFUTED", ()),
        ({"order": 4}, "REFUTED", ("delta != 0",)),
    ],
)
def test_an_exact_order_names_the_parameters(
    keys: dict[str, Any], verdict: str, domain: tuple[str, ...]
) -> None:
    found = judged(DUFFING, "order", **keys)
    assert (found.verdict, found.domain) == (verdict, domain)


def test_the_domain_of_h_and_of_the_stages_is_told() -> None:
    stages = ("q > 0", "H is smooth at the stages")
    found = judged(LOG, "area_preserving", "stormer-verlet", area_preserving=True)
    assert (found.verdict, found.domain) == ("PROVED", stages)
    assert judged(LOG, "order", order=3).domain == ("q > 0",)
    solved = ("the stages have a solution that depends smoothly on (p, q)",)
    quartic = judged(DUFFING, "area_preserving", "implicit-midpoint", area_preserving=True)
    assert (quartic.verdict, quartic.domain) == ("PROVED", solved)


def test_a_convergence_order_names_the_parameters() -> None:
    found = judged("p**2/2 + delta*q", "convergence_order", "lie1", convergence_order=1)
    assert (found.verdict, found.domain) == ("PROVED", ("delta != 0",))
    known = judged(DUFFING, "convergence_order", "implicit-midpoint", convergence_order=2)
    said = "delta is outside of a set of measure 0, not found, on which the difference at h^3 is 0"
    assert known.domain[-1] == f"{said} at every point"


def test_a_value_outside_of_what_is_written_is_refused() -> None:
    written = Hamiltonian.parse("p**2/2 + delta**2/delta*q")
    assert written.domain.texts == ("delta != 0",)
    assert written.with_values({"delta": 2}).domain.texts == ()
    with pytest.raises(InputError, match="delta = 0: is outside of delta != 0"):
        written.with_values({"delta": 0})


@pytest.mark.parametrize(
    ("formula", "domain"),
    [("h**3*H_pq**2/H_pq*0", ("H_pq != 0",)), ("0*h", ())],
)
def test_a_formula_of_every_h_is_judged_where_it_is_defined(
    formula: str, domain: tuple[str, ...]
) -> None:
    claim = models()["delta_j"].model_validate(
        {"id": "c", "scheme": "lie2", "kind": "delta_j", "formula": formula, "up_to": 3,
         "every": "hamiltonian"}
    )  # fmt: skip
    found = claim.judge(Findings({}))
    assert (found.verdict, found.domain) == ("PROVED", domain)
