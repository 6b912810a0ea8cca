"""The states of a run: what its rows hold, which of the states they are, and their digits."""

from collections.abc import Callable, Sequence
from fractions import Fraction

import numpy as np
import pytest

from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs import digits_on_demand
from verify.runs.orbit_table import orbit_of
from verify.runs.requested_run import run
from verify.scenes.observables import names
from verify.scenes.results.run import COLUMNS, OrbitTable, RunResult

H = Fraction(1, 10)


def duffing(arithmetic: str = "auto", steps: int = 20, scheme: str = "lie2") -> RunResult:
    made = systems.get("duffing").hamiltonian({"delta": 1})
    start = {"q": "0.5", "p": "0.25", "step_size": H, "steps": steps}
    return run(made, scheme, arithmetic=arithmetic, **start)


def numbers(table: OrbitTable, name: str) -> list[Fraction]:
    return [Fraction(text) for text in table.texts(name)]


def off_the_product(lam: Sequence[Fraction], delta_j: Sequence[Fraction]) -> Fraction:
    """By how much Λ_(k+1) is not Λ_k + ΔJ_k + Λ_k ΔJ_k, at most."""
    known = zip(lam, delta_j, lam[1:], strict=False)
    return max(abs(a + d + a * d - b) for a, d, b in known)


@pytest.mark.parametrize("arithmetic", ["auto", "mpfr"])
def test_rows_are_the_states_of_exact_arithmetic(arithmetic: str) -> None:
    """Explicit Euler on the harmonic oscillator: H grows by 1 + h² in every step, and so does Λ."""
    harmonic = Hamiltonian.parse("p**2/2 + q**2/2")
    found = run(harmonic, "euler", q=1, p=0, step_size=H, steps=12, arithmetic=arithmetic)
    table = orbit_of(found)
    p, q = Fraction(0), Fraction(1)
    for k, row in enumerate(table.rows):
        grown = (1 + H**2) ** k - 1
        true = (k * H, p, q, grown / 2, H**2, grown)
        for name, text, value in zip(COLUMNS, row, true, strict=True):
            assert abs(Fraction(text) - value) <= abs(value) / 10**16, (k, name)
        p, q = p - H * q, q + H * p


@pytest.mark.parametrize("arithmetic", ["float64", "auto"])
def test_delta_j_of_a_row_is_that_of_the_step_to_the_next(arithmetic: str) -> None:
    table = orbit_of(duffing(arithmetic))
    lam, delta_j = numbers(table, "lambda"), numbers(table, "delta_j")
    assert off_the_product(lam, delta_j) < Fraction(1, 10**15)
    assert off_the_product(lam, delta_j[1:]) > Fraction(1, 10**6), "a shifted column is seen"


def henon_heiles() -> RunResult:
    start = {"q": ["1/8", "4/9"], "p": ["3/7", "-2/5"], "step_size": "1/20", "steps": 5}
    return run(systems.get("henon-heiles").hamiltonian({}), "lie2", **start, arithmetic="mpfr",
               digits=25, observables=names(planar=False))  # fmt: skip


OF_TWO_DEGREES = ("t", "p1", "p2", "q1", "q2", "energy_error", "delta_j", "lambda",
                  "symplectic_defect")  # fmt: skip


@pytest.mark.parametrize(
    ("make", "columns", "shape", "first"),
    [
        (lambda: duffing("float64"), COLUMNS, (21,), {"q": Fraction(1, 2)}),
        (lambda: duffing("auto"), COLUMNS, (21,), {"q": Fraction(1, 2)}),
        (henon_heiles, OF_TWO_DEGREES, (6, 2), {"q1": Fraction(1, 8)}),
    ],
    ids=["float64", "auto", "two-degrees"],
)
def test_the_first_row_is_the_start_and_the_last_one_what_the_run_gives(
    make: Callable[[], RunResult],
    columns: tuple[str, ...],
    shape: tuple[int, ...],
    first: dict[str, Fraction],
) -> None:
    result = make()
    table = orbit_of(result)
    assert table.columns == columns
    assert table.p.shape == table.q.shape == shape
    start = first | dict.fromkeys(("t", "energy_error", "lambda"), 0)
    assert {name: numbers(table, name)[0] for name in start} == start
    last = {name: result.values[name] for name in {*columns} & {*result.values} - {"energy_error"}}
    known = {"t", "delta_j", "energy_error"}  # the energy is no value of every run
    assert last.keys() | known == {*columns}
    for name, value in last.items():
        assert abs(numbers(table, name)[-1] - Fraction(value.value)) <= Fraction(value.bound), name


def test_texts_of_float64_are_read_back_to_the_same_doubles() -> None:
    """Plain float64, written out, for the kick and the drift of symplectic Euler."""
    table = orbit_of(duffing("float64", scheme="symplectic-euler"))
    h, p, q = 0.1, 0.25, 0.5
    for k in range(1, len(table)):
        p = p - h * (q + q**3)
        q = q + h * p
        assert float(table.rows[k][1]) == pytest.approx(p, rel=1e-14, abs=0)
        assert float(table.rows[k][2]) == pytest.approx(q, rel=1e-14, abs=0)
    assert all(text == repr(float(text)) for text in table.texts("p"))


@pytest.mark.parametrize(
    ("points", "at"),
    [(20, range(21)), (7, [*range(0, 20, 3), 20]), (1, [0, 20]), (19, range(0, 21, 2))],
)
def test_points_thin_the_rows_and_the_last_state_stays(points: int, at: Sequence[int]) -> None:
    found = duffing("float64")
    table, all_of_them = orbit_of(found, points), orbit_of(found)
    assert numbers(table, "t") == [k * H for k in at]
    assert [*table.rows] == [all_of_them.rows[k] for k in at]
    assert len(table) <= points + 1


@pytest.mark.parametrize("arithmetic", ["float64", "auto"])
def test_an_orbit_that_leaves_the_range_is_told_up_to_its_last_finite_state(
    arithmetic: str,
) -> None:
    cubic = Hamiltonian.parse("p**2/2 - q**4/4")
    found = run(cubic, "lie2", q=4, p=4, step_size=H, steps=60, arithmetic=arithmetic)
    assert found.status == "left range"
    assert found.failed_step
    for points in (10_000, 3):
        table = orbit_of(found, points)
        assert numbers(table, "t")[-1] == (found.failed_step - 1) * H
        assert np.isfinite(table.p).all() or arithmetic != "float64"


def test_what_preserves_area_has_exact_zeros() -> None:
    table = orbit_of(duffing(scheme="stormer-verlet"))
    assert {*table.texts("delta_j"), *table.texts("lambda")} == {"0"}
    assert len(set(table.texts("energy_error"))) > 10


def test_a_step_that_solves_equations_has_its_orbit_too() -> None:
    table = orbit_of(duffing(scheme="gauss4", steps=3))
    assert numbers(table, "energy_error")[0] == 0
    assert 0 < abs(numbers(table, "energy_error")[-1]) < Fraction(1, 10**6)


def test_numbers_that_are_not_defined_are_empty_and_nan() -> None:
    """H = log q has no energy at a state with q < 0, which a step can reach."""
    made = Hamiltonian.parse("p**2/2 + log(q)")
    found = run(made, "symplectic-euler", q="0.05", p=0, step_size=H, steps=1)
    table = orbit_of(found)
    assert numbers(table, "q")[-1] < 0
    assert table.texts("energy_error")[-1] == ""
    assert np.isnan(table.energy_error[-1])


def test_arrays_are_the_columns() -> None:
    table = orbit_of(run(systems.get("harmonic").hamiltonian(
        {"omega": 1}), "rk4", q=1, p=0, step_size="1/3", steps=4))  # fmt: skip
    assert table.texts("t")[1] == "1/3"
    assert table.t.tolist() == [0, 1 / 3, 2 / 3, 1, 4 / 3]
    arrays = table.t, table.p, table.q, table.energy_error, table.delta_j, table.lambda_
    for name, array in zip(COLUMNS, arrays, strict=True):
        assert array.dtype == np.float64
        assert array.tolist() == [float(Fraction(text)) for text in table.texts(name)], name
    with pytest.raises(InputError, match="is delta_j meant"):
        table.texts("delta-j")


@pytest.mark.parametrize("points", [0, -1, 10_001, True, 2.5])
def test_points_are_a_whole_number_in_reach(points: int) -> None:
    with pytest.raises(InputError, match=r"points=.*whole number, 1 … 10000"):
        orbit_of(duffing(), points)


def test_a_long_table_shows_its_ends_in_a_notebook() -> None:
    shown = orbit_of(duffing())._repr_html_()
    assert shown.count("<tr>") == 1 + 5 + 1 + 5
    assert "<td>" not in shown
    assert "21 states, one every 1 steps" in shown
    assert repr(orbit_of(duffing(), 4)).startswith("OrbitTable(5 states, t = 0 … 2;")


def test_an_orbit_that_fixed_point_has_no_room_for_is_found_in_floating_point(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It begins at 1, where all fits, and ends at e¹³ = 442,413."""
    monkeypatch.setattr(digits_on_demand, "WORTH_COMPILING", 100)
    h, steps = Fraction(13, 200), 200
    saddle = Hamiltonian.parse("p**2/2 - q**2/2")
    found = run(saddle, "symplectic-euler", q=1, p=1, step_size=h, steps=steps, arithmetic="auto")
    last = orbit_of(found, 2).rows[-1]
    p = q = Fraction(1)
    for _ in range(steps):
        p += h * q
        q += h * p
    for text, true in zip(last[1:3], (p, q), strict=True):
        assert abs(Fraction(text) - true) <= abs(true) / 10**16
