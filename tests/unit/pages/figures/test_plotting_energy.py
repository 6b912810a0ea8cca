"""The energy drift drawn: a line for each energy, on a logarithmic axis."""

import pytest
from matplotlib.figure import Figure

import verify
from verify import InputError

RUN = {"q": 1.5, "p": 0, "step_size": 0.1, "steps": 30}


def test_a_line_for_h_and_one_for_each_further_term() -> None:
    runs = [verify.run("pendulum", name, **RUN) for name in ("stormer-verlet", "position-verlet")]
    figure = verify.plot_energy_drift(runs[0])
    (axes,) = figure.axes
    assert [line.get_label() for line in axes.get_lines()] == ["H", "H̃ to h²", "H̃ to h⁴"]
    assert (axes.get_yscale(), axes.get_ylabel(), axes.get_xlabel()) == (
        "log", "|H̃ − H̃₀|", "time t",
    )  # fmt: skip
    heights = [max(y for y in line.get_ydata() if y == y) for line in axes.get_lines()]
    assert heights == sorted(heights, reverse=True)
    own = Figure().add_subplot()
    assert verify.plot_energy_drift(runs, 2, ax=own) is own.figure
    labels = [line.get_label() for line in own.get_lines()]
    assert labels[0] == "stormer-verlet: H"
    assert labels[3] == "position-verlet: H̃ to h²"


def test_what_cannot_be_drawn_is_refused() -> None:
    with pytest.raises(InputError, match="is no RunResult"):
        verify.plot_energy_drift([])
    with pytest.raises(InputError, match="no modified Hamiltonian"):
        verify.plot_energy_drift(verify.run("pendulum", "lie1", **RUN))
