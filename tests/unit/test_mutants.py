"""The machinery of mutants: what is changed, that one mutant is planted, and what kills it."""

import ast
import json
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from tests.campaigns import mutants as campaign
from tests.mutants import battery, forked, killers, records, table
from tests.mutants.mutate import ROOT, Mutant, mutants, mutants_of, mutated, mutated_source, path_of
from tests.mutants.run import ordered
from tests.mutants.summary import explained, found_in, share
from tests.mutants.targets import modules, sample, shares

pytestmark = pytest.mark.left_to_ci


def made(source: str, operator: str | None = None) -> list[str]:
    """The sources of the mutants by one operator; by all where it is None."""
    return [
        ast.unparse(mutated_source(source, m.index))
        for m in mutants_of(source)
        if operator in (None, m.operator)
    ]


@pytest.mark.parametrize(
    ("operator", "source", "wanted"),
    [
        ("arithmetic", "a + b", ["a - b"]),
        ("arithmetic", "a * b", ["a / b"]),
        ("arithmetic", "a ** b // c", ["a ** b * c", "a * b // c"]),
        ("comparison", "a < b", ["a <= b"]),
        ("comparison", "a <= b == c", ["a < b == c", "a <= b != c"]),
        ("comparison", "a in b", ["a not in b"]),
        ("and-or", "a and b and c", ["a or b or c"]),
        ("not-dropped", "not a", ["a"]),
        ("minus-dropped", "-a", ["a"]),
        ("truth", "x = True", ["x = False"]),
        ("constant", "x = 7", ["x = 8", "x = 6"]),
        ("constant", "x = y[0]", ["x = y[1]", "x = y[-1]"]),
        ("condition", "a if b else c", ["a if True else c", "a if False else c"]),
        ("condition", "if a:\n    b", ["if True:\n    b", "if False:\n    b"]),
        ("condition", "while a:\n    b", ["while False:\n    b"]),
        ("condition", "[a for a in b if a]", ["[a for a in b if True]"]),
        ("min-max", "max(a, b)", ["min(a, b)"]),
        ("min-max", "any(a)", ["all(a)"]),
        ("arguments", "f(a, b)", ["f(b, a)"]),
        ("arguments", "max(a, b)", []),
        ("arguments", "f(a, a)", []),
        ("arguments", "f(*a, b)", []),
        ("term-dropped", "a + b", ["a", "b"]),
        ("term-dropped", "a - b", ["a"]),
        ("term-dropped", "f'{a}' + b", []),
        ("factor-dropped", "a * b", ["a", "b"]),
        ("factor-dropped", "a / b", ["a"]),
        ("square-dropped", "a ** 2 + b * b", ["a + b * b", "a ** 2 + b"]),
        ("rounding", "x.abs_upper()", ["x.abs_lower()"]),
        ("rounding", "math.floor(x)", ["math.ceil(x)"]),
        (
            "other-of-two",
            "f(p, s.h_q, 'q')",
            ["f(q, s.h_q, 'q')", "f(p, s.h_p, 'q')", "f(p, s.h_q, 'p')"],
        ),
        ("element-dropped", "f([a, b, c])", ["f([b, c])", "f([a, b])"]),
        (
            "returned",
            "def f() -> bool:\n    return a",
            ["def f() -> bool:\n    return True", "def f() -> bool:\n    return False"],
        ),
        ("statement-dropped", "a += b", ["pass"]),
        ("statement-dropped", "a.append(b)", ["pass"]),
        (
            "return-negated",
            "def f() -> bool:\n    return a",
            ["def f() -> bool:\n    return not a"],
        ),
        ("return-negated", "def f() -> int:\n    return a", []),
        ("slice", "a[1:-1]", ["a[2:-1]", "a[1:-2]"]),
        ("slice", "a[b:]", ["a[b + 1:]", "a[b:-1]"]),
        ("constant", "a[1:2]", []),
    ],
)
def test_each_operator_makes_what_it_says(operator: str, source: str, wanted: list[str]) -> None:
    assert made(source, operator) == wanted


@pytest.mark.parametrize(
    "source",
    [
        '"""Text with 1 + 1."""',
        'x = "a" + f"{n + 1}"',
        "from a import b",
        "assert a < 1",
        "raise InputError('a', 1 + 1, 'is not 1') from None",
        "x: Literal[1] | None",
        "def f(a: int | None) -> tuple[int, int] | None: ...",
        "@cache(1)\ndef f(): ...",
        "class A:\n    def __repr__(self):\n        return a + b",
        "if TYPE_CHECKING:\n    x = 1",
        "Start = tuple[A, B] | None",
        "x = isinstance(a, A | B)",
        "x = zip(*a, strict=True)",
        "_MOST = 5000",
        "_GUARD = 12",
        "_HALVINGS, _NEWTON = 6, 8",
        "x = f(pipelined=True, chunk=1)",
    ],
)
def test_what_computes_nothing_is_not_changed(source: str) -> None:
    assert made(source) == []


def test_the_rules_of_what_is_left_alone_are_narrow() -> None:
    """Their twins: what looks alike and is computed is changed."""
    assert made("x = a + b")
    assert made("x: int = 1")
    assert made("def f(a: int = 1): ...")
    assert made("if a.checking:\n    x = 1", "constant")
    assert made("SIZES = a[b] | c", "arithmetic")
    assert made("def f():\n    return 5000")
    assert made("_MOST = 50")
    assert made("_GUARD = f(12)")
    assert made("_GUARD, _MOST = 1, 2")
    assert made("def f():\n    _GUARD = 12")
    kept = "if x not in a:\n    a[x] = b"
    assert made(kept, "condition") == ["if False:\n    a[x] = b"]
    assert len(made(kept.replace("a[x]", "c[x]"), "condition")) == 2
    assert len(made(kept.replace("not in", "in"), "condition")) == 2
    assert made("x = f(a, large=True)") == ["x = f(a, large=False)"]


def test_every_mutant_compiles_differs_and_has_its_own_key() -> None:
    """One of each module. Which modules there are is known when all are read: not on import."""
    assert len(modules()) > 50
    for k, module in enumerate(modules()):
        found = mutants(module)
        assert len({m.key for m in found}) == len(found), module
        sound = ast.dump(ast.parse(path_of(module).read_text(encoding="utf-8")))
        mutant = found[k % len(found)]
        tree = mutated(module, mutant.index)
        compile(tree, module, "exec")
        assert ast.dump(tree) != sound, mutant.key


def test_mutants_are_enumerated_alike_in_every_process() -> None:
    few = (
        "verify.arithmetic.exact",
        "verify.proof.order_for_one_h",
        "verify.schemes.maps.step_map",
    )
    keys = f"print([m.key for m in sample(60, 7, {few})])"
    asked = f"from tests.mutants.targets import sample; {keys}"
    command = [sys.executable, "-c", asked]
    said = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert said.strip() == str([m.key for m in sample(60, 7, few)])
    assert [m.key for m in sample(60, 8, few)] != [m.key for m in sample(60, 7, few)]


def test_a_sample_has_its_size_and_something_of_every_module() -> None:
    drawn = sample(300, 7)
    assert len(drawn) == len({m.key for m in drawn}) == 300
    assert {m.module for m in drawn} == set(modules())
    assert shares({"a": 1, "b": 10, "c": 100}, 12) == {"a": 1, "b": 1, "c": 10}
    assert shares({"a": 1, "b": 2}, 10) == {"a": 1, "b": 2}


# -- planting ---------------------------------------------------------------------------------


def one(module: str, change: str) -> Mutant:
    (found,) = [m for m in mutants(module) if change in m.key]
    return found


COMBINATION = "verify.algebra.linear_algebra"
PLANTED = """
import sys
from collections import Counter
from tests.mutants.planted import planted
if {index} >= 0:
    planted({module!r}, {index})
import {module} as there
from verify.execution.keeper import fingerprint
import verify.algebra.jets as beside
print(type(beside.__loader__).__name__, type(there.__loader__).__name__, fingerprint(), sep=";")
"""


def in_a_process(source: str) -> str:
    command = [sys.executable, "-c", source]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    return done.stdout.strip()


def test_one_module_is_planted_and_nothing_on_disk_is_changed() -> None:
    mutant = one(COMBINATION, "last in pivots → True")
    before = {
        p: p.stat().st_mtime_ns for p in (ROOT / "verify" / "algebra").rglob("linear_algebra*")
    }
    source = records.source()
    changed = in_a_process(PLANTED.format(module=COMBINATION, index=mutant.index)).split(";")
    sound = in_a_process(PLANTED.format(module=COMBINATION, index=-1)).split(";")
    assert changed[:2] == ["SourceFileLoader", "_Changed"]
    assert sound[:2] == ["SourceFileLoader", "SourceFileLoader"]
    assert changed[2] != sound[2], "what is kept on disk would be taken for the sound code's"
    assert records.source() == source
    after = {
        p: p.stat().st_mtime_ns for p in (ROOT / "verify" / "algebra").rglob("linear_algebra*")
    }
    assert {p: t for p, t in after.items() if p in before} == before


def test_a_mutant_that_comes_too_late_is_refused() -> None:
    import verify.errors  # noqa: F401
    from tests.mutants.planted import planted

    with pytest.raises(RuntimeError, match="comes first"):
        planted(COMBINATION, 0)


# -- children ---------------------------------------------------------------------------------


def raising() -> dict[str, str]:
    raise ValueError("no such thing")


def hanging() -> dict[str, str]:
    while True:
        pass


def test_a_child_is_done_or_dies_or_hangs() -> None:
    assert forked.forked(lambda: {"by": None}, 5).value == {"by": None}
    died = forked.forked(raising, 5)
    assert (died.how, died.said) == ("died", "ValueError: no such thing")
    assert forked.forked(lambda: sys.exit(0), 5).how == "died"
    assert forked.forked(hanging, 1).how == "timeout"


# -- killers ----------------------------------------------------------------------------------

CHECK = """
from verify import schemes
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
def test_ruth3_has_order_three():
    scheme = schemes.get("ruth3")
    proof = prove(scheme.step_map(Hamiltonian.parse("p**2/2 + q**4/4")), scheme)
    assert proof.convergence_order == 3
"""
RUN = """
import json, sys
from functools import partial
from pathlib import Path
from tests.mutants import forked, killers
forked.warm_up()
killer = killers.Killer("mine", 2, partial(killers._tests, Path({path!r})))
of = "verify.schemes.methods.splitting.ruth3"
found = [forked.forked(partial(killers.on_sound_code, killer, (of,)), 60).value]
for index in {indices}:
    work = partial(killers.on_mutant, killer, of, index, {{}})
    found.append(forked.forked(work, 60).value)
print(json.dumps(found))
"""


def test_a_killer_passes_on_sound_code_and_kills_a_wrong_scheme(tmp_path: Path) -> None:
    """Also one that raises; and what it does not look at lives."""
    path = tmp_path / "test_mine.py"
    path.write_text(CHECK)
    ruth = "verify.schemes.methods.splitting.ruth3"
    wrong = [one(ruth, "minus-dropped -2"), one(ruth, "Fraction(7, 24) → Fraction(24, 7)")]
    broken, unseen = one(ruth, "alternating(_SIZES"), one(ruth, "truth False → True")
    text = RUN.format(path=str(path), indices=[m.index for m in (*wrong, broken, unseen)])
    sound, *killed, lives = json.loads(in_a_process(text).splitlines()[-1])
    assert sound["by"] is None
    assert len(sound["entered"][ruth]) == 1, "the module's own code, which makes its scheme"
    assert {k["by"] for k in killed} == {"test_mine.py::test_ruth3_has_order_three"}
    assert "KeyError" in killed[-1]["why"]
    assert lives["by"] is None


def test_the_killers_are_all_files_of_properties_and_the_battery_where_it_is() -> None:
    found = killers.killers(60)
    assert [k.name for k in found if k.stage == 1] == [killers.BATTERY] * battery.there()
    files = {p.name for p in (ROOT / "tests" / "property").rglob("test_*.py")}
    assert {Path(k.name).name for k in found if k.stage == 2} == files
    assert "tests/unit/schemes/maps/test_step_map.py" in {
        k.name for k in killers.unit_killers("verify.schemes.maps.step_map")
    }


def test_what_is_near_and_cheap_is_asked_first() -> None:
    """The battery looks at all modules, and a file at those that it imports, or their package."""
    folder = ROOT / "tests" / "property"
    files = (
        "kernels/test_reach.py",
        "schemes/test_splitting_conditions.py",
        "flows/test_extrapolation.py",
    )
    made = [killers.of_file(folder / name, 2) for name in files]
    made.append(killers.Killer(killers.BATTERY, 1, lambda _: {}))
    far, near, other, battery_ = (k.name for k in made)
    seconds = {far: 1, near: 9, other: 2, battery_: 5}
    sound = [{"killer": name, "seconds": s} for name, s in seconds.items()]
    mutant = mutants("verify.schemes.conditions.splitting_conditions")[0]
    assert [k.name for k in ordered(mutant, sound, made)] == [battery_, near, far, other]


# -- what is told -----------------------------------------------------------------------------


def record(key: str, by: str | None, how: str = "failed") -> records.Record:
    found = {"kind": "mutant", "key": key, "module": key.partition(":")[0], "operator": "truth"}
    return found | ({"killed": False, "by": None} if by is None else
                    {"killed": True, "by": by, "how": how, "why": ""})  # fmt: skip


def test_results_are_read_back_also_after_a_line_that_was_cut(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    records.add(path, record("a:1", None))
    path.write_text(path.read_text() + '{"kind": "mut')
    records.add(path, record("b:1", "test_x"))
    assert [r["key"] for r in records.read(path)] == ["a:1", "b:1"]


def test_the_page_shows_each_property_with_a_mutant_and_each_survivor_with_its_reason() -> None:
    results = [record("a:1 x | y → x & y", "test_x"), record("a:2", None), record("b:1", None)]
    results += [record("b:2", "battery", "timeout")] * 2
    page = table.page(results, {"a:2": "It is the same.", "c:9": "Gone."})
    assert "Killed: **2 of 4 (50.0 %)**" in page
    assert "no errors" not in page
    with_one = table.page(results, {"a:2": "It is the same."}, {"a:2", "b:2", "c:9"})
    assert "1 of the survivors" in with_one
    assert "**2 of 3 (66.6 %)** are killed" in with_one, "one that is killed is an error"
    assert "| test_x | 1 | `a:1 x \\| y → x & y` |" in page
    assert "| `a:2` | It is the same. | – |" in page
    assert "| `b:1` | **not explained** | – |" in page
    assert "- `c:9`" in page
    assert "| `b` | 2 | 1 | 1 | 50 |" in page
    assert "battery |" not in page, "a hang is no property"
    assert found_in(results, {"a:2"}).killed == 0
    assert share(899, 1000) == "899 of 1000 (89.9 %)"


def test_each_mutant_that_is_explained_is_one_of_todays_source() -> None:
    gone = [entry["change"] for entry, keys in explained() if len(keys) != 1]
    assert not gone


def test_of_changes_that_read_alike_in_a_line_one_is_explained(tmp_path: Path) -> None:
    """In `a = 2 * x + 2` two constants are changed alike."""
    module = "verify.proof.certificates.named_numbers"
    lines = path_of(module).read_text(encoding="utf-8").splitlines()
    told = [(lines[m.line - 1].strip(), f"{m.operator} {m.change}") for m in mutants(module)]
    (line, change), _ = next(x for x in Counter(told).items() if x[1] == 2)
    path = tmp_path / "survivors.toml"

    def keys(more: str) -> tuple[str, ...]:
        entry = f"module = {json.dumps(module)}\nline = {json.dumps(line)}\n"
        path.write_text(f'[[survivor]]\n{entry}change = {json.dumps(change)}\nwhy = "x"\n{more}')
        ((_, found),) = explained(path)
        return found

    assert len(keys("")) == 2
    assert keys("nth = 0") + keys("nth = 1") == keys("")
    assert keys("nth = 2") == ()


# -- the campaign ---------------------------------------------------------------------------------


class Reached:
    """Which tests reach what, made up: by module and line, with their seconds."""

    def __init__(self, lines: dict[int, list[str]], seconds: dict[str, float]) -> None:
        self.lines, self.seconds = lines, seconds

    def tests(self, module: str, line: int | None = None) -> list[str]:
        found = {t for n, tests in self.lines.items() if line in (None, n) for t in tests}
        return sorted(found, key=lambda name: self.seconds[name])


def test_the_tests_of_a_mutants_room_that_reach_its_line_come_first() -> None:
    mutant = Mutant("verify.runs.orbit_table", 0, 7, 0, "constant", "1 → 2", 5)
    near, far, room, dear = (
        "tests/unit/runs/test_a.py::test_x", "tests/unit/pages/test_b.py::test_y",
        "tests/unit/runs/test_a.py::test_z", "tests/unit/runs/test_a.py::test_dear",
    )  # fmt: skip
    reached = Reached(
        {7: [near, far, dear], 90: [room]}, {near: 2.0, far: 1.0, room: 0.5, dear: 99}
    )
    assert campaign.reaching(mutant, reached) == [near, far, room]  # type: ignore[arg-type]
    assert campaign.reaching(mutant, reached, 1.5) == [far]  # type: ignore[arg-type]


@pytest.mark.parametrize(("planted", "killed"), [(True, True), (False, False)])
def test_a_mutant_is_planted_in_the_process_of_the_tests(planted: bool, killed: bool) -> None:
    """One that the test has to see, and one of another module."""
    test = "tests/unit/kernels/test_partials.py::test_the_solution_is_that_of_the_system"
    module = "verify.kernels.step.matrix_operations" if planted else "verify.pages.answers"
    chosen = next(m for m in mutants(module) if not planted or m.change.startswith("pivots +="))
    status, said = campaign._run(chosen, [test], 120)
    assert (status not in (0, None)) is killed, said
