"""Runs in n degrees of freedom, judged: regular, chaotic, leaving; each with its control."""

from math import log

import pytest

import verify
from verify.errors import InputError
from verify.runs.tangent_growth import is_exponential
from verify.scenes.results.stability import StabilityResult

REGULAR = {"q": [0, "0.1"], "p": ["0.4", 0]}  # of energy 0.085
CHAOTIC = {"q": [0, "-0.1"], "p": ["0.5", "0.2"]}  # of energy 0.1503


def judged(system: str, scheme: str, h: str, time: int, **start: object) -> StabilityResult:
    (found,) = verify.stability(system, scheme, step_size=h, time=time, **start)  # type: ignore[arg-type]
    return found


def test_a_good_scheme_on_a_regular_orbit_is_stable() -> None:
    found = judged("henon-heiles", "stormer-verlet", "0.1", 60, **REGULAR)
    assert found.kind == "stable"
    assert found.q == ("0", "0.1")
    assert "no faster than a power of t" in str(found.exact_orbit)


def test_an_unstable_scheme_on_a_regular_orbit_is_to_blame() -> None:
    found = judged("henon-heiles", "euler", "0.1", 60, **REGULAR)
    assert found.kind == "unstable: scheme"
    assert found.step is not None
    before = judged("henon-heiles", "euler", "0.1", 10, **REGULAR)
    assert before.kind != "unstable: scheme"


def test_a_step_that_is_too_large_is_the_schemes_fault() -> None:
    found = judged("henon-heiles", "stormer-verlet", "2.1", 60, **REGULAR)
    assert found.kind == "unstable: scheme"


@pytest.mark.left_to_ci
def test_chaos_of_the_exact_motion_is_no_schemes_fault() -> None:
    """float64 parts from high precision: so do exact neighbours, without any rounding."""
    found = judged("henon-heiles", "stormer-verlet", "0.1", 320, **CHAOTIC)
    assert found.kind == "sensitive"
    assert found.lyapunov is not None
    assert 0.05 < float(found.lyapunov) < 0.2
    assert "float64 parts at step" in str(found.detail)


def test_rounding_on_a_regular_orbit_stays_small_and_an_energy_that_moves_on_is_a_drift() -> None:
    found = judged("henon-heiles", "lie4", "0.1", 100, **REGULAR)
    assert found.kind == "drifts"
    assert found.rate is not None
    assert float(found.rate) < 0


def test_what_leaves_by_itself_escapes() -> None:
    inverted = "(p1**2 + p2**2)/2 - q1**2/2 - q2**2/2"
    found = judged(inverted, "stormer-verlet", "0.1", 40, q=[1, 0], p=[0, 1])
    assert found.kind == "escapes"


def test_powers_of_t_are_told_from_exponentials() -> None:
    times = [float(k) for k in range(101)]
    for power in (0, 1, 2):
        assert is_exponential(times, [power * log(1 + t) for t in times]) is False
    assert is_exponential(times, [t / 10 for t in times]) is True
    assert is_exponential(times, [t / 20 for t in times]) is None


def test_a_start_of_another_length_and_what_is_of_the_plane_are_refused() -> None:
    with pytest.raises(InputError, match=r"^q=0: has 1 of 2 numbers"):
        judged("henon-heiles", "rk4", "0.1", 1, q=[0], p=[0, 0])
    from verify.calls.inputs import scene_of

    with pytest.raises(InputError, match="criteria takes p and q"):
        scene_of("henon-heiles", "rk4", None, criteria=[1])
