"""Claims on what one step keeps, of an H and of equations; each has a false one beside it."""

from pathlib import Path

import pytest

from tests.unit.claims.test_check import check_file
from verify.claims.claims_file import load_claims
from verify.errors import InputError
from verify.verdict import Verdict

PREY = 'field = "u_dot = u*(v - 2); v_dot = v*(1 - u)"\n'
EULER = 'scheme = "u_next = u*exp(h*(v - 2)); v_next = v*exp(h*(1 - u*exp(h*(v - 2))))"\n'
HENON = 'hamiltonian = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + (q1**2 + q2**2)**2"\n'
SPLITTING = """
field = "x_dot = y; y_dot = -sin(x)"
scheme = "A 1/2; B 1; A 1/2"
keeps = "symmetric"
split = [{ name = "A", field = "x_dot = y" }, { name = "B", field = "y_dot = -sin(x)" }]
"""
CLAIMS = {
    "form": PREY + 'keeps = "symplectic"\nform = "du^dv/(u*v)"\ndefect_order = 5\nscheme = "rk4"\n',
    "density": PREY + EULER + 'keeps = "volume"\ndensity = "1/(u*v)"\n',
    "integral": PREY + EULER + 'keeps = "2*log(v) - v + log(u) - u"\ndefect_order = 2\n',
    "energy": 'system = "pendulum"\nscheme = "lie2"\nkeeps = "energy"\ndefect_order = 3\n',
    "momentum": HENON + 'scheme = "stormer-verlet"\nkeeps = "angular-momentum"\n',
    "reversible": 'system = "pendulum"\nscheme = "stormer-verlet"\nkeeps = "reversible"\n',
    "splitting": SPLITTING,
    "every": 'every = "hamiltonian"\ndegrees = 2\nscheme = "gauss4"\nkeeps = "angular-momentum"\n',
    "every-order": 'every = "separable hamiltonian"\nscheme = "stormer-verlet"\n'
    'keeps = "energy"\ndefect_order = 3\n',
}
FALSE = {
    "splitting": ("A 1/2; B 1; A 1/2", "A 1; B 1"),
    "form": ("defect_order = 5", "defect_order = 6"),
    "density": (EULER, 'scheme = "rk4"\n'),
    "integral": ("defect_order = 2", "defect_order = 3"),
    "energy": ("defect_order = 3", ""),
    "momentum": ("stormer-verlet", "lie4"),
    "reversible": ("stormer-verlet", "lie2"),
    "every": ("gauss4", "rk4"),
    "every-order": ("= 3", "= 4"),
}


def claim(name: str, keys: str) -> str:
    return f'[[claim]]\nid = "{name}"\nkind = "keeps"\n{keys}\n'


@pytest.fixture(scope="module")
def verdicts(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Verdict]:
    content = "".join(claim(name, keys) for name, keys in CLAIMS.items())
    content += "".join(claim(f"not-{n}", CLAIMS[n].replace(*change)) for n, change in FALSE.items())
    results = check_file(tmp_path_factory.mktemp("claims"), content)
    return {name: result.verdict for name, result in results.items()}


@pytest.mark.parametrize("name", CLAIMS)
def test_a_true_claim_is_proved_and_a_false_one_refuted(
    name: str, verdicts: dict[str, Verdict]
) -> None:
    assert (verdicts[name], verdicts[f"not-{name}"]) == (Verdict.PROVED, Verdict.REFUTED)


def test_the_verdict_says_where_it_holds(tmp_path: Path) -> None:
    result = check_file(tmp_path, claim("density", CLAIMS["density"]))["density"]
    assert result.domain == ("u != 0", "v != 0")
    assert str(result.evidence).endswith("is 0 at every step, where u ≠ 0, v ≠ 0")


def test_a_map_that_follows_no_flow_keeps_nothing_that_counts(tmp_path: Path) -> None:
    still = 'system = "pendulum"\nscheme = "p_next = p; q_next = q"\nkeeps = "energy"\n'
    result = check_file(tmp_path, claim("still", still))["still"]
    assert result.verdict is Verdict.UNDECIDED
    assert "no step of this system" in result.evidence


def test_claims_share_a_field_with_its_parts_and_may_name_a_scene_that_has_them(
    tmp_path: Path,
) -> None:
    field, scheme, keeps, split = SPLITTING.strip().splitlines()
    shared = f"[defaults]\n{field}\n{split}\n{keeps}\n"
    scene = f'[[scene]]\nname = "own"\n{field}\n{scheme.replace("scheme =", "schemes = [")}]\n'
    scene += split + "\n"
    content = claim("parts", scheme) + claim("other", 'scheme = "rk4"')
    content += claim("scene", f'{scheme}\nscene = "own"')
    verdicts = {n: x.verdict for n, x in check_file(tmp_path, shared + content + scene).items()}
    assert verdicts == {"parts": "PROVED", "other": "REFUTED", "scene": "PROVED"}


# what is wrong -> (keys, its line, what the message must hold)
BAD = {
    "name": (PREY + 'scheme = "rk4"\nkeeps = "volum"', 6, "keeps=volum: unknown; is volume meant"),
    "key": (PREY + 'scheme = "rk4"\nkeeps = "volume"\nfrom = "u"', 7, "from=u: unknown key"),
    "density": (
        PREY + 'scheme = "rk4"\nkeeps = "volume"\ndensity = "1/w"',
        7,
        "density=1/w: at column 3: unknown name 'w'",
    ),
    "not-kept": (PREY + 'scheme = "rk4"\nkeeps = "volume"', 6, "is not kept by the exact flow"),
    "order": (PREY + 'scheme = "rk4"\nkeeps = "volume"\ndefect_order = 0', 7, "must be 1 or more"),
    "equation": (
        'field = "u_dot"\nscheme = "rk4"\nkeeps = "volume"',
        4,
        "field=u_dot: has no equation",
    ),
    "part": (SPLITTING.replace("B 1;", "C 1;"), 6, "scheme=C: unknown; allowed: A, B"),
    "split-of-an-h": (
        SPLITTING.replace('field = "x_dot = y; y_dot = -sin(x)"', 'system = "pendulum"'),
        8,
        "split=A, B: are parts of equations",
    ),
    "sum": (SPLITTING.replace('-sin(x)" }', 'sin(x)" }'), 8, "split=y_dot: the parts do not"),
    "two-systems": (PREY + 'system = "pendulum"\nscheme = "rk4"\nkeeps = "volume"', 5, "give one"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_one_is_refused_with_its_line(name: str, tmp_path: Path) -> None:
    keys, line, message = BAD[name]
    path = tmp_path / "claims.toml"
    path.write_text(claim("c", keys))
    with pytest.raises(InputError) as refused:
        load_claims(path)
    assert str(refused.value).startswith(f"claims.toml:{line}: claim c: ")
    assert message in str(refused.value)
    assert "--" not in str(refused.value)
