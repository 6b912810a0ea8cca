"""Reference data in n degrees of freedom: what is made is right, what is damaged is found, and a
user's table is judged."""

import json
from collections.abc import Callable
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.helpers.constructed.reference import made, put, repaired
from verify.errors import InputError
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS
from verify.reference.check.folder_check import CheckResult, check
from verify.reference.compare.comparison import TableComparison, compare
from verify.reference.compare.published_data import load
from verify.reference.compare.submitted_table import has_degrees, read
from verify.reference.compare.table_agreement import ColumnVerdict
from verify.reference.make.data_files import OF_DEGREES
from verify.reference.make.data_folder import PUBLISHED, data_of
from verify.reference.make.scene_plan import plan_references
from verify.scenes.scene import scene_from_toml

SCENES = {
    "heiles": """
hamiltonian = "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2 + q1**2*q2 - q2**3/3"
schemes = ["lie1", "lie2", "stormer-verlet"]
[[reference]]
step_sizes = [0.05]
initial_values = [{ q = [0.3, 0.1], p = [0, "1/3"] }]
steps = [0, 1, 20]
digits = 18
""",
    "three": """
hamiltonian = "p1**2/2 + p2**2/2 + p3**2/2 - cos(q1 - q2) + a*q3**2*cos(t) + q2*q3"
parameters = { a = "1/2" }
t0 = 0.25
schemes = ["lie1", "explicit-midpoint"]
[[reference]]
step_sizes = [0.1]
initial_values = [{ q = [0.3, 0.1, 1], p = [0, "1/3", -0.5] }]
steps = [0, 3]
digits = 12
""",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("reference") / "set"
    put(found, made(SCENES), SCENES)
    return found


def look(folder: Path, share: float = 1.0) -> CheckResult:
    return check(folder, share=share, seed=1)


def test_what_was_made_agrees_and_is_computed_again(folder: Path) -> None:
    found = look(folder)
    assert not found.differences
    assert not found.not_recomputed
    assert found.recomputed == found.rows == 9 + 3 + 3 + 4 + 2 + 2
    names = {path.name for path in folder.iterdir()}
    assert OF_DEGREES in names
    assert "data.schema.json" not in names, "nothing of it is of the plane"


def test_the_schema_holds_for_what_was_made(folder: Path) -> None:
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads((folder / OF_DEGREES).read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    for name in SCENES:
        content = json.loads((folder / f"{name}.json").read_text())
        validator.validate(content)
        assert not validator.is_valid(content | {"planted": 1})


def test_a_run_is_that_of_fractions(folder: Path) -> None:
    """lie1 by hand: z' = z + h f, J = 1 + h A, W = MᵀΩM − Ω."""
    data = json.loads((folder / "heiles.json").read_text())
    (run,) = (x for x in data["runs"] if x["scheme"] == "lie1")
    h = Fraction(1, 20)
    z = [Fraction(0), Fraction(1, 3), Fraction(3, 10), Fraction(1, 10)]
    one = [[Fraction(a == b) for b in range(4)] for a in range(4)]
    m, largest, volume = one, Fraction(0), Fraction(1)
    for n in range(21):
        for row in run["rows"]:
            if row["step"] == n:
                p1, p2, q1, q2 = z
                energy = (p1**2 + p2**2 + q1**2 + q2**2) / 2 + q1**2 * q2 - q2**3 / 3
                wanted = {"energy": energy, "symplectic_defect": greatest(m), "lambda": volume - 1}
                if n:
                    wanted["symplectic_defect_max"] = largest
                for name, x in wanted.items():
                    assert_near(row[name], x)
                for at, x in zip([*row["p"], *row["q"]], z, strict=True):
                    assert_near(at, x)
        p1, p2, q1, q2 = z
        f = [-(q1 + 2 * q1 * q2), -(q2 + q1**2 - q2**2), p1, p2]
        a = [[0, 0, -(1 + 2 * q2), -2 * q1], [0, 0, -2 * q1, -(1 - 2 * q2)],
             [1, 0, 0, 0], [0, 1, 0, 0]]  # fmt: skip
        j = [[one[r][c] + h * a[r][c] for c in range(4)] for r in range(4)]
        largest = max(largest, greatest(j))
        volume *= determinant(j)
        m = [[sum(j[r][k] * m[k][c] for k in range(4)) for c in range(4)] for r in range(4)]
        z = [x + h * y for x, y in zip(z, f, strict=True)]


def greatest(j: list[list[Fraction]]) -> Fraction:
    def entry(a: int, b: int) -> Fraction:
        own = sum((j[i][a] * j[2 + i][b] - j[2 + i][a] * j[i][b] for i in (0, 1)), Fraction(0))
        return own - ((b == a + 2) - (a == b + 2))

    return max(abs(entry(a, b)) for a, b in product(range(4), repeat=2))


def determinant(j: list[list[Fraction]]) -> Fraction:
    if len(j) == 1:
        return j[0][0]
    minors = ([row[:c] + row[c + 1 :] for row in j[1:]] for c in range(len(j)))
    return sum(((-1) ** c * j[0][c] * determinant(x) for c, x in enumerate(minors)), Fraction(0))


def assert_near(cell: dict[str, str], wanted: Fraction) -> None:
    assert abs(Fraction(cell["value"]) - wanted) <= Fraction(cell["radius"])


# -- damage ---------------------------------------------------------------------------------------


def one_digit(cell: dict[str, str]) -> None:
    cell["value"] = cell["value"].replace("1", "2", 1) if "1" in cell["value"] else "7e+00"


DAMAGES: dict[str, Callable[[Any], Any]] = {
    "q2": lambda data: one_digit(data["runs"][1]["rows"][2]["q"][1]),
    "energy": lambda data: one_digit(data["runs"][1]["rows"][2]["energy"]),
    "W": lambda data: one_digit(data["runs"][1]["rows"][2]["symplectic_defect"]),
    "S": lambda data: one_digit(data["runs"][1]["rows"][2]["symplectic_defect_max"]),
    "lambda": lambda data: one_digit(data["runs"][1]["rows"][2]["lambda"]),
    "flow": lambda data: one_digit(data["flow"][0]["rows"][2]["p"][0]),
    "order": lambda data: data["proofs"][1].update(order=2),
    "leading": lambda data: data["proofs"][1]["leading"].update({"dp1∧dq1": "2*p2"}),
    "an entry left out": lambda data: data["proofs"][1]["leading"].pop("dp1∧dq2"),
    "symplectic": lambda data: data["proofs"][1].update(symplectic=True),
    "convergence": lambda data: data["proofs"][2].update(convergence_order=3),
    "the start": lambda data: data["runs"][0].update(q=["0.3", "0.2"]),
    "a row": lambda data: data["runs"][0].update(rows=data["runs"][0]["rows"][:2]),
}


@pytest.mark.left_to_ci
@pytest.mark.parametrize("damage", DAMAGES)
def test_what_is_damaged_is_found(damage: str, folder: Path, tmp_path: Path) -> None:
    """Also where all files are made from the damaged numbers again, so that they fit together."""
    from verify.reference.make.models import DataInDegrees

    data = json.loads((folder / "heiles.json").read_text())
    DAMAGES[damage](data)
    other = json.loads((folder / "three.json").read_text())
    put(tmp_path / "set", [DataInDegrees.model_validate(x) for x in (data, other)], SCENES)
    assert look(tmp_path / "set").differences


@pytest.mark.parametrize("letter", ["p", "q"])
@pytest.mark.parametrize("many", [1, 3])
def test_a_state_of_another_length_is_found(
    letter: str, many: int, folder: Path, tmp_path: Path
) -> None:
    from verify.reference.make.models import DataInDegrees

    data = json.loads((folder / "heiles.json").read_text())
    row = data["runs"][1]["rows"][2]
    row[letter] = (row[letter] * 2)[:many]
    put(tmp_path / "set", [DataInDegrees.model_validate(data)], {"heiles": SCENES["heiles"]})
    assert {x.column for x in look(tmp_path / "set").differences} >= {"p, q"}


LEAVES = """
hamiltonian = "p1**2/2 + p2**2/2 + q1*log(q1) - q1 + q2**2*q1"
schemes = ["lie2"]
[[reference]]
step_sizes = [1]
initial_values = [{ q = [0.5, 0.2], p = [-2, 0] }]
steps = [0, 1, 3, 5]
digits = 8
flow = false
"""


def test_an_orbit_that_is_not_defined_any_more_has_left(tmp_path: Path) -> None:
    """Its energy is null where H is not defined; all rows after are of the step that left."""
    (data,) = made({"pole": LEAVES})
    rows = data.runs[0].rows
    assert [row.status for row in rows] == ["finished", "finished", "left range", "left range"]
    put(tmp_path / "set", [data], {"pole": LEAVES})
    found = look(tmp_path / "set")
    assert not found.differences
    assert not found.not_recomputed
    assert found.recomputed == found.rows == 5
    raw = data.model_dump(mode="json", by_alias=True)
    raw["runs"][0]["rows"][3]["failed_step"] += 1
    put(tmp_path / "set", [type(data).model_validate(raw)], {"pole": LEAVES})
    assert [x.column for x in look(tmp_path / "set").differences] == ["failed_step"]


def test_results_that_were_kept_make_the_same_data() -> None:
    """Also where a row of the flow has no numbers, and so is one of the plane's, too."""
    scene = scene_from_toml(LEAVES.replace("flow = false", ""), "pole")
    results = execute(plan_references([scene]), Store(None), where=THIS_PROCESS)
    kept = {
        k: type(x).model_validate_json(x.model_dump_json(by_alias=True)) for k, x in results.items()
    }
    data = data_of(scene, results)
    assert "not followed" in {row.status for row in data.flow[0].rows}
    assert data_of(scene, kept) == data


def test_a_folder_of_both_kinds_is_checked_and_read(folder: Path, tmp_path: Path) -> None:
    plane = {"mine": 'hamiltonian = "p**2/2 + q**4"\nschemes = ["lie1"]\n[[reference]]\n'
             'step_sizes = [0.1]\ninitial_values = [{ q = 1, p = 0 }]\nsteps = [0, 2]\n'
             'digits = 9\nflow = false\n'}  # fmt: skip
    both = plane | {"heiles": SCENES["heiles"]}
    put(tmp_path / "set", made(both), both)
    assert not look(tmp_path / "set", share=0.2).differences
    assert [run.scene for run in load(tmp_path / "set", None).runs()] == ["mine"]
    several = load(tmp_path / "set", None, planar=False)
    assert {run.scene for run in several.runs()} == {"heiles"}
    path = tmp_path / "set" / "mine.json"
    path.write_bytes((folder / "heiles.json").read_bytes())
    repaired(tmp_path / "set", "mine.json")
    assert look(tmp_path / "set", share=0).differences, "of another kind than its scene"


# -- a user's table -------------------------------------------------------------------------------


def program(path: Path, *, columns: str = "p1,p2,q1,q2", sign: int = 1, late: int = 0,
            off: float = 0.0, eta: int = 2, less: float = 1.0) -> Path:  # fmt: skip
    """lie2 for Hénon and Heiles in doubles, with W and Λ from the entries of its Jacobians."""
    h, omega = 0.05, np.zeros((4, 4))
    omega[0, 2] = omega[1, 3] = 1
    omega -= omega.T
    z, m, largest, volume = np.array([0, 1 / 3, 0.3, 0.1]), np.eye(4), 0.0, 1.0
    lines = [f"step,{columns},energy,symplectic_defect_max,symplectic_defect,lambda"]
    for n in range(22):
        p1, p2, q1, q2 = z
        energy = (p1**2 + p2**2 + q1**2 + q2**2) / 2 + q1**2 * q2 - q2**3 / 3
        shown = [*(z * [sign, sign, 1, 1] * (1 + off)), energy, largest,
                 np.abs(m.T @ omega @ m - omega).max(), volume - less]  # fmt: skip
        cells = [f"{x:.17g}" for x in shown]
        cells[5] = cells[5] if n else ""
        if n >= late:
            lines.append(",".join([str(n - late), *cells]))
        f = np.array([-(q1 + 2 * q1 * q2), -(q2 + q1**2 - q2**2), p1, p2])
        a = np.array([[0, 0, -(1 + 2 * q2), -2 * q1], [0, 0, -2 * q1, -(1 - 2 * q2)],
                      [1, 0, 0, 0], [0, 1, 0, 0]])  # fmt: skip
        b = np.array([[0, 0, -2 * p2, -2 * p1], [0, 0, -2 * p1, 2 * p2],
                      [0, 0, 0, 0], [0, 0, 0, 0]])  # fmt: skip
        second = h * h / 2 if eta == 2 else 0.0
        j = np.eye(4) + h * a + second * (a @ a + b)
        z = z + h * f + second * (a @ f)
        largest = max(largest, np.abs(j.T @ omega @ j - omega).max())
        m, volume = j @ m, volume * np.linalg.det(j)
    path.write_text("\n".join(lines) + "\n")
    return path


def compared(folder: Path, table: Path, **given: str) -> TableComparison:
    ours = load(folder, "heiles", planar=False)
    return compare(ours, read(table, ours, {"scheme": "lie2", **given}, {}))


def test_a_right_program_differs_by_rounding_alone(folder: Path, tmp_path: Path) -> None:
    found = compared(folder, program(tmp_path / "mine.csv"))
    assert found.agrees
    assert found.rows == 3
    assert {x.name: x.verdict for x in found.columns}["p1"] in (
        ColumnVerdict.AGREES,
        ColumnVerdict.ROUNDING,
    )
    assert len(found.columns) == 8
    assert min(x.digits for x in found.columns if x.name[0] in "pq") > 14


def test_inputs_are_lists_and_may_be_doubles(folder: Path, tmp_path: Path) -> None:
    table = program(tmp_path / "mine.csv")
    ours = load(folder, None, planar=False)
    theirs = read(
        table, ours, {"scheme": "lie2", "q0": "0.3, 0.1", "p0": "0,0.3333333333333333"}, {}
    )
    assert [run.label for run, _ in theirs.runs.values()] == [
        "heiles: lie2, h = 0.05, q = (0.3, 0.1), p = (0, 1/3)"
    ]
    assert set(theirs.read_as) == {"p0_2"}
    assert compare(ours, theirs).agrees


def test_what_is_told_may_leave_one_run(tmp_path: Path) -> None:
    ours = load(PUBLISHED, "several-henon-heiles", planar=False)
    table = tmp_path / "mine.csv"
    table.write_text("step,p1\n0,0.4\n")
    told = {"scheme": "lie2", "step_size": "0.1", "q0": "0,0.1"}
    assert list(read(table, ours, told, {}).runs) == [
        "several-henon-heiles: lie2, h = 0.1, q = (0, 0.1), p = (0.4, 0)"
    ]
    with pytest.raises(InputError, match=r"--q: is wanted, .* has: 0.1, -0.1"):
        read(table, ours, {"scheme": "lie2"}, {})
    none = read(table, ours, {"step_size": "0.07"}, {})
    assert (none.outside, none.runs) == (1, {})


@pytest.mark.parametrize(
    ("wrong", "mistake"),
    [
        ({"columns": "p2,p1,q2,q1"}, "degrees-1-2"),
        ({"columns": "q1,q2,p1,p2"}, "swapped"),
        ({"sign": -1}, "sign-of-p"),
        ({"late": 1}, "late+1"),
        ({"eta": 1}, "scheme-lie1"),
        ({"less": 0.0}, "product"),
        ({"off": 1e-11}, None),
    ],
)
def test_a_mistake_is_named(
    wrong: dict[str, Any], mistake: str | None, folder: Path, tmp_path: Path
) -> None:
    found = compared(folder, program(tmp_path / "mine.csv", **wrong))
    assert not found.agrees
    named = [name for each in found.diagnoses for name, _ in each.mistakes]
    assert named == ([mistake] if mistake else [])
    assert bool(found.unexplained) is (mistake is None)


def test_tables_that_cannot_be_taken_are_refused_in_one_line(folder: Path, tmp_path: Path) -> None:
    table = program(tmp_path / "mine.csv")
    ours = load(folder, None, planar=False)
    assert has_degrees(table, {})
    with pytest.raises(InputError, match=r"--scheme.*is wanted"):
        read(table, ours, {"scene": "heiles"}, {})
    with pytest.raises(InputError, match=r"--scene.*is wanted: 2 have such runs: heiles, three"):
        read(table, ours, {}, {})
    with pytest.raises(InputError, match="has no row of these data"):
        compared(folder, table, step_size="0.07")
    with pytest.raises(InputError, match=r"scene=none: unknown; .*allowed: "):
        read(table, ours, {"scene": "none"}, {})
    with pytest.raises(InputError, match="has no row of these data"):
        compared(folder, table, q0="0.3,0.1,0", p0="0,1/3,0")
    keyed = "\n".join(f"{'lie2' if n else 'scheme'},{x}" for n, x in
                      enumerate(table.read_text().splitlines()))  # fmt: skip
    (tmp_path / "keyed.csv").write_text(keyed)
    with pytest.raises(InputError, match=r"--scheme=lie2: is a column of the table, too"):
        compared(folder, tmp_path / "keyed.csv")
    table.write_text("step,p1,q1\n1.5,0,0\n")
    with pytest.raises(InputError, match="which is not a whole number"):
        compared(folder, table)
    table.write_text("p1,q1\n0,0\n")
    with pytest.raises(InputError, match="no column step or time"):
        compared(folder, table)


def test_a_start_of_another_length_is_refused() -> None:
    with pytest.raises(InputError, match="of 2 numbers"):
        scene_from_toml(SCENES["heiles"].replace("[0.3, 0.1]", "[0.3]"), "heiles")


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (lambda run: run["rows"][2]["energy"].update(value="1e+9999999"), "beyond all sizes"),
        (lambda run: run.update(q=["1/0", "1"]), "1/0"),
        (lambda run: run.update(q=["1", "1", "1"]), "of 2 numbers"),
        (lambda run: run.update(q="1"), "is no reference data"),
    ],
)
def test_hostile_data_are_refused_in_one_line(
    change: Callable[[Any], Any], problem: str, folder: Path, tmp_path: Path
) -> None:
    data = json.loads((folder / "heiles.json").read_text())
    change(data["runs"][0])
    (tmp_path / "heiles.json").write_text(json.dumps(data))
    with pytest.raises(InputError, match=problem) as found:
        load(tmp_path, None, planar=False)
    assert "\n" not in str(found.value)
