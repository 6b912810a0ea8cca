"""Bad input in a claims file: each with the file, its line and its claim."""

import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.claims.claims_file import load_claims
from verify.errors import InputError
from verify.scenes.toml_file import lines_of

# -- lines ----------------------------------------------------------------------------------------

WINDING = '''# [[claim]]
title = "a # [[claim]]"   # x
defaults.scheme = "lie2"

[[claim]]
id = "a"
"p_next" = """
[[claim]]
id = "not a key"
a\\""""""
entries = [
  ["1", "]"], # ]
  ["[", '"'],
]
parameters.delta = 1
  [claim.more]
  z = 1
[[ "claim" ]]   # here
id = \'\'\'
[[claim]]\'\'\'
x = { a = [1], b = "}" }
"y z" = 1
[[claim]]
'''


def test_lines_are_found_among_strings_comments_and_arrays() -> None:
    tomllib.loads(WINDING)
    tables = lines_of(WINDING).tables
    assert [t.line for t in tables["claim"]] == [5, 18, 23]
    first, second, third = (t.keys for t in tables["claim"])
    assert first == {"id": 6, "p_next": 7, "entries": 11, "parameters": 15, "more": 16}
    assert second == {"id": 19, "x": 21, "y z": 22}
    assert third == {}
    assert tables[""][0].keys == {"title": 2, "defaults": 3}


VALUES = st.sampled_from(
    ['"x"', "1", '"""a\n[[t]]\nk = 1"""', "[1,\n 2]", "'''\n#'''", '{ a = "]" }', '"\\""',
     "[ # ]\n]", '"""""""', "1979-05-27"]
)  # fmt: skip


@drawn(60)
@given(
    st.lists(st.lists(st.tuples(st.sampled_from(["", "# [[t]]\n", "\n\n"]), VALUES), max_size=4))
)
def test_the_line_of_every_key_is_where_it_was_written(tables: Any) -> None:
    text, expected = "", []
    for table in tables:
        expected.append((text.count("\n") + 1, {}))
        text += "[[t]] # head\n"
        for k, (before, value) in enumerate(table):
            text += before
            expected[-1][1][f"k{k}"] = text.count("\n") + 1
            text += f"k{k} = {value}\n"
    try:
        tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return
    found = [(t.line, t.keys) for t in lines_of(text).tables.get("t", [])]
    assert found == expected


# -- bad input ------------------------------------------------------------------------------------

HEAD = """title = "Mine"
[defaults]
scheme = "lie2"
system = "duffing"
parameters = { delta = 1 }

[[claim]]
id = "first"
kind = "order"
order = 3

[[claim]]
id = "mine"
"""  # the second claim begins on line 12
RUN = "step_size = 0.1\nsteps = 9\nq = 1\np = 0\n"
MSE = 'kind = "mse"\nprinted = "1e-9"\n' + RUN
TABLE = 'kind = "table"\nstep_sizes = [0.1, 0.2]\nsteps = 9\nq = 1\np = 0\n'

# name -> (the second claim's keys, the line that is named, what else the message holds)
BAD: dict[str, tuple[str, int, str]] = {
    "no-kind": ("order = 3\n", 12, "kind='': unknown; allowed: alike, area_preserving"),
    "unknown-kind": ('source = "x"\nkind = "feeling"\n', 15, "kind=feeling"),
    "unknown-key": ('kind = "order"\norder = 3\nspeed = 1\n', 16, "speed=1: unknown key"),
    "missing-key": ('kind = "order"\n', 12, "order: is missing"),
    "order-0": ('kind = "order"\n\norder = 0\n', 16, "order=0"),
    "order-text": ('kind = "order"\norder = "3"\n', 15, "order=3"),
    "area-number": ('kind = "area_preserving"\narea_preserving = 1\n', 15, "area_preserving=1"),
    "id-twice": ('kind = "order"\norder = 3\nid = "first"', 16, ""),
    "formula": ('kind = "delta_j"\nformula = "h**3*eps"\n', 15, "unknown name 'eps'"),
    "formula-code": ('kind = "delta_j"\nformula = "open(1)"\n', 15, "unknown function"),
    "after-lines": ('kind = "delta_j"\nsource = """\n\n"""\nformula = "h**"\n', 18, "formula"),
    "entry": ('kind = "jacobian"\nentries = [\n  ["1", "0"],\n  ["x", "1"],\n]\n', 15,
              "entries.1.0=x"),
    "three-entries": ('kind = "jacobian"\nentries = [["1", "0"], ["0"]]\n', 15, "entries"),
    "q-next": ('kind = "step_map"\np_next = "p"\nq_next = "q + r"\n', 16, "q_next=q + r"),
    "p-next-in-itself": ('kind = "step_map"\np_next = "p_next"\nq_next = "q"\n', 15, "p_next"),
    "scheme": ('kind = "order"\norder = 3\nscheme = "rk5"\n', 16, "scheme=rk5: unknown; is rk4"),
    "not-separable": (
        'kind = "order"\norder = 3\nscheme = "symplectic-euler"\nhamiltonian = "p*q**2"\n', 17,
        "explicit only for"),
    "system": ('kind = "order"\norder = 3\nsystem = "lorenz"\n', 16, "system=lorenz: unknown"),
    "two-subjects": ('kind = "order"\norder = 3\nsystem = "duffing"\nhamiltonian = "p**2"\n', 16,
                     "give one of"),
    "hamiltonian": ('kind = "order"\norder = 3\nhamiltonian = "q/0"\n', 16, "by zero"),
    "parameter": ('kind = "order"\norder = 3\nparameters = { eps = 1 }\nsystem = "duffing"\n', 16,
                  "parameter=eps"),
    "parameter-nan": (
        'kind = "order"\norder = 3\nsystem = "duffing"\nparameters.delta = nan\n', 17, "nan"),
    "symbol-in-a-run": (MSE + 'system = "duffing"\n', 20, "delta: has no value"),
    "scene-missing": ('kind = "order"\norder = 3\nscene = "lorenz"\n', 16, "no lorenz.toml beside"),
    "scene-path": ('kind = "order"\norder = 3\nscene = "../x"\n', 16, "is no name of a scene"),
    "every-of-a-splitting": (
        'kind = "order"\norder = 3\nscheme = "stormer-verlet"\nevery = "hamiltonian"\n', 17,
        "say 'separable hamiltonian'"),
    "every-of-ones-own": (
        'kind = "order"\norder = 3\nscheme = "p_next = p; q_next = q"\nevery = "hamiltonian"\n', 16,
        "is given for one H"),
    "every-what": ('kind = "order"\norder = 3\nevery = "system"\n', 16, "every"),
    "every-step-map": ('kind = "step_map"\np_next = "p"\nq_next = "q"\nevery = "hamiltonian"\n', 17,
                       "a claim of kind step_map speaks of one H"),
    "every-mse": (MSE + 'every = "hamiltonian"\n', 20, "a claim of kind mse speaks of one H"),
    "every-and-system": (
        'kind = "order"\norder = 3\nevery = "hamiltonian"\nsystem = "duffing"\n', 17, "says which"),
    "every-exactly": ('kind = "delta_j"\nformula = "0"\nevery = "hamiltonian"\n', 12,
                      "up_to: is missing"),
    "every-names": ('kind = "delta_j"\nup_to = 4\nformula = "delta"\nevery = "hamiltonian"\n', 16,
                    "derivatives such as H_pq"),
    "every-parameters": (
        'kind = "order"\norder = 3\nevery = "hamiltonian"\nparameters = { a = 1 }\n', 17,
        "says which H"),
    "printed-word": ('kind = "mse"\nprinted = "about 3"\n' + RUN, 15, "is not a printed decimal"),
    "printed-true": ('kind = "mse"\nprinted = true\n' + RUN, 15, "is not a printed decimal"),
    "printed-twice": ('kind = "mse"\nprinted = 1\nlg_printed = 2\n' + RUN, 15, "give one of"),
    "nothing-printed": ('kind = "mse"\n' + RUN, 12, "give one of the two"),
    "h-zero": (MSE.replace("0.1", "0"), 16, "must be greater than 0"),
    "h-missing": (MSE.replace("step_size = 0.1\n", ""), 12, "step_size: is missing"),
    "n-zero": (MSE.replace("9\nq", "0\nq"), 17, "steps=0"),
    "time-and-steps": (MSE + "time = 9\n", 17, "give one of time and steps"),
    "no-time": (MSE.replace("steps = 9\n", ""), 12, "time: is missing"),
    "h-beyond-time": (MSE.replace("steps = 9", "time = 0.01"), 16, "makes 0 steps"),
    "q-missing": (MSE.replace("q = 1\n", ""), 18, "q: is missing"),
    "p-nan": (MSE.replace("p = 0", "p = nan"), 19, "nan"),
    "digits": (MSE + "digits = 0\n", 20, "digits=0"),
    "table-width": (TABLE + 'printed = ["1"]\n', 19, "give 2 values"),
    "table-rows": (TABLE + 'rows = [["1", "2"], ["1", "2"]]\n', 19, "give 1, one an initial value"),
    "table-of-words": (TABLE + 'printed = ["1", "x"]\n', 19, "printed.1"),
    "table-nothing": (TABLE, 12, "give one of the two"),
    "bound-negative": ('kind = "bounded"\nbound = -1\n' + RUN, 15, "bound"),
    "growth-word": ('kind = "growth"\ngrowth = "fast"\n' + RUN, 15, "growth=fast"),
    "growth-short": ('kind = "growth"\ngrowth = "linear"\n' + RUN, 15, "needs 64 steps"),
    "runs-of-a-formula": ('kind = "order"\norder = 3\nstep_size = 0.1\n', 16, "unknown key"),
    "magnitude-no-h": ('kind = "magnitude"\nexponents = { mse = 1 }\nquantifier = "some"\n', 12,
                       "step_size: is missing"),
}  # fmt: skip


def write(folder: Path, content: str) -> Path:
    path = folder / "claims.toml"
    path.write_text(content)
    return path


@pytest.mark.parametrize(("body", "line", "held"), BAD.values(), ids=BAD)
def test_bad_input_names_the_file_the_line_and_the_claim(
    tmp_path: Path, body: str, line: int, held: str
) -> None:
    content = HEAD + body
    if "id = " in body:
        content = content.replace('id = "mine"\n', "\n")
    with pytest.raises(InputError) as caught:
        load_claims(write(tmp_path, content))
    name = "first" if "id = " in body else "mine"
    message = str(caught.value)
    assert message.startswith(f"claims.toml:{line}: claim {name}"), message
    assert held in message
    assert "\n" not in message
    assert len(message) < 500


def test_the_file_that_the_bad_ones_are_made_of_is_good(tmp_path: Path) -> None:
    for body in (MSE, TABLE + 'printed = ["1", "2"]\n', 'kind = "order"\norder = 3\n'):
        assert len(load_claims(write(tmp_path, HEAD + body)).claims) == 2


@pytest.mark.parametrize(
    ("content", "held"),
    [
        ("title = 1\nclaims = []\n[[claim]]\nid = 3", "claims.toml:2: claims=[]: unknown; allowed"),
        ("[defaults]\nspeed = 1\n[[claim]]\nid = 3", "claims.toml:2: defaults: speed=1"),
        ('[defaults]\nid = "x"\n[[claim]]\n', "claims.toml:2: defaults: id=x"),
        (
            "[defaults]\nstep_size = 0\n"
            + HEAD.partition("[defaults]\n")[2]
            + MSE.replace("step_size = 0.1\n", ""),
            "claims.toml:2: claim mine: step_size",
        ),
        ("[[claim]]\n", "claims.toml:1: claim number 1: kind"),
        ("x = 1", "must hold [[claim]] tables"),
        ("claim = []", "must hold [[claim]] tables"),
        ("claim = [3]", "claims.toml:1: claim number 1"),
        ('\nclaim = [{ kind = "x" }]', "claims.toml:2: claim number 1: kind=x"),
        ("[[claim]]\nid = 3\nkind = 'order'\n", "claims.toml:2: claim number 1"),
        ('[[scene]]\nsystem = "duffing"\n[[claim]]\n', "claims.toml:1: scene"),
        ('[[scene]]\nname = "a"\n[[claim]]\n', "claims.toml:1: scene: schemes"),
        ("scene = 3\n[[claim]]\n", "write [[scene]] tables"),
        ("defaults = 3\n[[claim]]\n", "is not a table"),
        ("claim = [", "is not TOML"),
    ],
)
def test_a_file_that_is_no_claims_file_is_named(tmp_path: Path, content: str, held: str) -> None:
    with pytest.raises(InputError) as caught:
        load_claims(write(tmp_path, content))
    assert held in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["missing.toml", "."])
def test_a_file_that_cannot_be_read_is_named(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match=r"^file="):
        load_claims(tmp_path / name)
