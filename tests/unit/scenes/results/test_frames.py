"""Results as tables of pandas and as grids of xarray, and what is said without them."""

import sys

import numpy as np
import pytest

import verify
from verify.errors import InputError
from verify.scenes.results.sweep import Sweep

pandas = pytest.importorskip("pandas")
xarray = pytest.importorskip("xarray")


@pytest.fixture(scope="module")
def sweep() -> Sweep:
    return verify.sweep(
        "duffing", ["lie2", "rk4"], parameters={"delta": ["1/3", 2]}, q=1.5, p=0,
        step_size=[0.1, 0.05], steps=4,
    )  # fmt: skip


def test_a_sweep_is_a_table_with_a_row_a_run(sweep: Sweep) -> None:
    table = sweep.to_dataframe()
    assert isinstance(table, pandas.DataFrame)
    assert [*table.columns] == [*sweep.columns]
    assert table["scheme"].tolist() == ["lie2"] * 4 + ["rk4"] * 4
    assert table["delta"].tolist() == [1 / 3, 2.0] * 4
    assert table["lambda"].tolist() == [float(run.values["lambda"]) for run in sweep]
    assert set(table["status"]) == {"finished"}


def test_a_sweep_is_a_grid_over_what_was_varied(sweep: Sweep) -> None:
    grid = sweep.to_xarray()
    assert dict(grid.sizes) == {"scheme": 2, "step_size": 2, "q": 1, "p": 1, "delta": 2}
    there = grid["lambda"].sel(scheme="rk4", step_size=0.05, delta=2, q=1.5, p=0)
    (run,) = [
        run
        for run in sweep
        if (run.scheme, run.step_size) == ("rk4", "0.05") and dict(run.parameters)["delta"] == "2"
    ]
    assert there.item() == float(run.values["lambda"])
    assert grid["lambda_bound"].dtype == np.float64
    assert (grid["lambda_bound"] > 0).all()


def test_what_an_orbit_lacks_is_nan_in_its_table() -> None:
    orbit = verify.run("pendulum", "lie2", q=1.5, p=0, step_size=0.1, steps=3).orbit
    table = orbit.to_dataframe()
    assert table["t"].tolist() == [0.0, 0.1, 0.2, 0.3]
    assert table["p"].tolist() == [float(text) for text in orbit.texts("p")]


def test_a_separation_is_a_table_and_a_grid() -> None:
    found = verify.separate_grid("pendulum", "lie2", q=1.5, p=0, step_sizes=[0.1, 0.05], time=1)
    table = found.to_dataframe()
    assert len(table) == 2 * len(set(table["way"]))
    plain = found.points[0].plain
    assert plain is not None
    grid = found.to_xarray()
    there = grid["truncation"].sel(way="plain", step_size=float(found.points[0].step_size))
    assert there.item() == float(plain.parts.truncation)


@pytest.mark.parametrize("name", ["pandas", "xarray"])
def test_without_the_library_it_is_one_line(
    name: str, sweep: Sweep, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    call = {"pandas": sweep.to_dataframe, "xarray": sweep.to_xarray}[name]
    with pytest.raises(InputError, match=f"library={name}: is not installed, and to_.*needs it"):
        call()
