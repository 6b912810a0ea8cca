"""A claim beyond the limits is undecided, its file goes on; a closer look decides what it can."""

from fractions import Fraction
from pathlib import Path

import pytest

from tests.unit.claims.test_check import check_file
from verify.claims.claims_file import load_claims
from verify.errors import InputError, LimitError
from verify.verdict import Verdict

PROVED, REFUTED, UNDECIDED = Verdict.PROVED, Verdict.REFUTED, Verdict.UNDECIDED
HEAD = """
[defaults]
scheme = "lie2"
system = "duffing"

[[claim]]
id = "beside"
kind = "delta_j"
formula = "3*h**3*delta*p*q"
up_to = 4

"""
BEYOND = {
    "not smooth": 'formula = "3*h**3*delta*abs(p*q)"',
    "unknown function": 'formula = "3*h**3*delta*erf(p*q)"',
    "terms": 'formula = "(1 + p + q + h + delta)**60"',
    "exponent": 'formula = "p**65*h"',
    "number": 'formula = "1e99999*h"',
    "|q|": 'formula = "sqrt(q**2)*h"',
    "own H": 'formula = "h**4"\nhamiltonian = "p**2/2 + abs(q)"',
    "closed form": 'formula = "h**4"\nscheme = "rk4"\n'
                   'hamiltonian = "sqrt(1 + p**2)*exp(q) + sin(p*q) + cos(q/(1 + p**2))"',
}  # fmt: skip


def claim(name: str, keys: str) -> str:
    return f'[[claim]]\nid = "{name}"\nkind = "delta_j"\nstatement = "As printed."\n{keys}\n'


def test_what_is_beyond_the_limits_costs_one_claim(tmp_path: Path) -> None:
    content = HEAD + "".join(claim(f"c{k}", keys) for k, keys in enumerate(BEYOND.values()))
    found = check_file(tmp_path, content)
    assert found["beside"].verdict is PROVED
    others = {name: found[f"c{k}"] for k, name in enumerate(BEYOND)}
    assert {name: each.verdict for name, each in others.items()} == dict.fromkeys(BEYOND, UNDECIDED)
    assert "abs is not smooth" in others["not smooth"].evidence
    assert "claims.toml:16: claim c0" in others["not smooth"].evidence
    assert all(each.statement == "As printed." for each in others.values())


@pytest.mark.parametrize(
    "keys",
    ['formula = "3*h**3*detla*p*q"', 'formula = "sni(q)*h"', 'formula = "open(1)"',
     'formula = "3*h**3*("', 'formula = "h/0"', 'formula = "log(-1)*h"',
     'formula = "h"\nup_to = 99', 'formul = "h"'],
)  # fmt: skip
def test_a_mistake_in_the_file_is_one_all_the_same(tmp_path: Path, keys: str) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(HEAD + claim("c", keys))
    with pytest.raises(InputError, match="claim c") as error:
        load_claims(path)
    assert not isinstance(error.value, LimitError)


RUN = """
[[claim]]
id = "{}"
kind = "bounded"
hamiltonian = "p**2/2 + q**2/2"
scheme = "lie2"
step_size = 0.1
steps = 3
q = 1
p = 0
bound = "{}"
"""


def test_a_bound_that_is_near_asks_for_more_digits(tmp_path: Path) -> None:
    """det J of lie2 is 1 + h⁴/4 here, so that Λ is a decimal that is known."""
    exact = (1 + Fraction(1, 40000)) ** 3 - 1
    least = Fraction(1, 10**60)
    bounds = {"equal": exact, "above": exact + least, "below": exact - least}
    found = check_file(tmp_path, "".join(RUN.format(n, x) for n, x in bounds.items()))
    verdicts = {name: each.verdict for name, each in found.items()}
    assert verdicts == {"equal": UNDECIDED, "above": Verdict.ENCLOSED, "below": REFUTED}
    # What is printed shows on which side it is.
    assert len(found["above"].evidence.partition("max |Λ| = ")[2].partition(" ")[0]) > 60


EVERY = """
[[claim]]
id = "{}"
kind = "convergence_order"
convergence_order = {}
every = "separable hamiltonian"
scheme = "{}"
"""
VERLET = "kick 1/2; drift 1; kick 1/2"
_W = "1/(2 - 2**(1/3))"
_V = f"(1 - 2*{_W})"
YOSHIDA = (
    f"kick {_W}/2; drift {_W}; kick ({_W} + {_V})/2; drift {_V}; kick ({_W} + {_V})/2;"
    f" drift {_W}; kick {_W}/2"
)


def test_a_splitting_that_states_no_order_is_looked_at_as_far_as_the_claim(tmp_path: Path) -> None:
    orders = {VERLET: 2, YOSHIDA: 4}
    asked = [(s, k) for s in orders for k in range(1, 7)]
    content = "".join(EVERY.format(n, k, scheme) for n, (scheme, k) in enumerate(asked))
    found = check_file(tmp_path, content)
    for n, (scheme, k) in enumerate(asked):
        assert found[str(n)].verdict is (PROVED if orders[scheme] == k else REFUTED)
