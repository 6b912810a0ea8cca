"""Runs of H(p, q, t), held against loops in mpmath that share no code with the toolkit."""

from collections.abc import Callable
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from mpmath.ctx_mp import MPContext

import verify
from verify import arithmetic as number_systems
from verify.errors import InputError
from verify.execution.keeper import Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import check_times
from verify.kernels.kernel import kernel_for
from verify.kernels.stepping import KernelRun
from verify.runs.a_posteriori_bound import certify
from verify.runs.requested_run import run
from verify.scenes.results.run import RunResult

PENDULUM = "p**2/2 - (1 + cos(2*t)/2)*cos(q)"
MIXED = "p**2*(1 + q**2)/2 + q**2*sin(t)/2"
H, STEPS, T0 = Fraction(1, 100), 300, Fraction(1, 3)
SYSTEMS = ("fixed", "mpfr", "mpmath", "ball", "float64")
Step = Callable[[Any, Any, Any, Any, Any], tuple[Any, Any]]

own = MPContext()
own.dps = 60


def lie2(p: Any, q: Any, t: Any, h: Any, c: Any) -> tuple[Any, Any]:
    g, dg = 1 + c.cos(2 * t) / 2, -c.sin(2 * t)
    sin, cos = c.sin(q), c.cos(q)
    return (
        p - h * g * sin - h**2 / 2 * (dg * sin + g * p * cos),
        q + h * p - h**2 / 2 * g * sin,
    )


def verlet(p: Any, q: Any, t: Any, h: Any, c: Any) -> tuple[Any, Any]:
    p = p - h / 2 * (1 + c.cos(2 * t) / 2) * c.sin(q)
    q = q + h * p
    return p - h / 2 * (1 + c.cos(2 * (t + h)) / 2) * c.sin(q), q


def rk4(p: Any, q: Any, t: Any, h: Any, c: Any) -> tuple[Any, Any]:
    def f(p: Any, q: Any, t: Any) -> tuple[Any, Any]:
        return -(p * p * q + q * c.sin(t)), p * (1 + q * q)

    a = f(p, q, t)
    b = f(p + h / 2 * a[0], q + h / 2 * a[1], t + h / 2)
    d = f(p + h / 2 * b[0], q + h / 2 * b[1], t + h / 2)
    e = f(p + h * d[0], q + h * d[1], t + h)
    return tuple(x + h / 6 * (a[i] + 2 * b[i] + 2 * d[i] + e[i]) for i, x in enumerate((p, q)))  # type: ignore[return-value]


CASES: dict[str, tuple[str, str, Step]] = {
    "lie2": ("lie2", PENDULUM, lie2),
    "verlet": ("stormer-verlet", PENDULUM, verlet),
    "rk4": ("rk4", MIXED, rk4),
}


def by_hand(step: Step, steps: int = STEPS, t0: Fraction = T0) -> dict[str, Fraction]:
    """p and q after the steps, to 50 digits and more, and Λ by differences that are as good."""

    def number(x: Fraction) -> Any:
        return own.mpf(x.numerator) / x.denominator

    h, p, q, log = number(H), own.mpf(0), own.mpf(1), own.mpf(1)
    tiny = own.mpf(10) ** -25
    for k in range(steps):
        t = number(t0 + k * H)
        at = [
            step(p + u, q + v, t, h, own) for u, v in ((tiny, 0), (-tiny, 0), (0, tiny), (0, -tiny))
        ]
        (a, c), (b, d) = (
            tuple((x - y) / (2 * tiny) for x, y in zip(at[i], at[i + 1], strict=True))
            for i in (0, 2)
        )
        log *= a * d - b * c
        p, q = step(p, q, t, h, own)
    found = {"p": p, "q": q, "lambda": log - 1}
    return {n: Fraction(int(x * 2**180)) / 2**180 for n, x in found.items()}


def ran(case: str, name: str, **more: Any) -> RunResult:
    scheme, formula, _ = CASES[case]
    asked: dict[str, Any] = {
        "q": 1, "p": 0, "step_size": H, "steps": STEPS, "t0": T0, "arithmetic": name, "digits": 25,
        "observables": ("lambda",),
    }  # fmt: skip
    return run(Hamiltonian.parse(formula), scheme, **asked | more)


@pytest.mark.sample(3)
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("name", SYSTEMS)
def test_a_run_is_that_of_the_loop_by_hand(name: str, case: str) -> None:
    found, true = ran(case, name), by_hand(CASES[case][2])
    assert found.status == "finished"
    assert found.arithmetic == name
    for key, value in found.values.items():
        wrong = abs(Fraction(value.value) - true[key])
        # Differences of 10⁻²⁵ give the determinants of 300 steps to some 40 digits.
        assert wrong <= Fraction(value.bound) + Fraction(1, 10**35), key
    if name != "float64":
        assert {v.value for v in found.values.values()} == {
            v.value for v in ran(case, "mpfr").values.values()
        }


def test_a_clock_that_stands_still_gives_other_numbers() -> None:
    """The planted error beside it: the force read at t₀ in every step."""
    step = CASES["lie2"][2]
    right = by_hand(step)
    frozen = by_hand(lambda p, q, t, h, c: step(p, q, own.mpf(1) / 3, h, c))
    assert abs(right["q"] - frozen["q"]) > Fraction(1, 100)


@pytest.mark.parametrize("name", ["fixed", "mpfr", "mpmath"])
def test_a_bound_that_forgets_the_clock_would_be_too_small(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Bounds count how far t may be off: a thousand times that makes them larger."""
    made = number_systems.get(name, 25)
    start = {"p": Fraction(0), "q": Fraction(1), "h": H, "t": T0}
    kernel_run = KernelRun(
        Hamiltonian.parse(PENDULUM), "lie2", start, STEPS, frozenset({"lambda"}), 0
    )
    outcome = kernel_run.run(made, tangent=True)
    right = certify(kernel_run, made, outcome)
    from verify.runs import step_bounds

    true = step_bounds.bound_time_error
    monkeypatch.setattr(step_bounds, "bound_time_error", lambda a, x: 1000 * true(a, x))
    worse = certify(kernel_run, made, outcome)
    assert right is not None
    assert worse is not None
    assert all(worse[key] > right[key] for key in ("p", "q", "lambda"))


@pytest.mark.left_to_ci
def test_what_the_format_cuts_off_from_h_does_not_add_up() -> None:
    """h = 1/3 and a million steps: t is right to the last place at the end, too."""
    for formula in ("p**2/2 + q*t/1000000", "p**2/2 - (1 + cos(t)/2)*q"):
        found = [
            run(
                Hamiltonian.parse(formula), "symplectic-euler", q=1, p=0, t0="1/7",
                step_size="1/30000", steps=100_000, arithmetic=name, digits=30, observables=(),
            )
            for name in ("fixed", "mpfr")
        ]  # fmt: skip
        assert [each.arithmetic for each in found] == ["fixed", "mpfr"]
        assert [{n: v.value for n, v in each.values.items()} for each in found[:1]] == [
            {n: v.value for n, v in each.values.items()} for each in found[1:]
        ]


def test_fixed_leaves_its_range_with_notice_where_a_t_without_a_period_does() -> None:
    ran = partial(run, scheme="lie2", q=1, p=0, step_size=H, steps=STEPS, t0=100_000, digits=25)
    chirp = Hamiltonian.parse("p**2/2 + q**2/2 - q*cos(t**2)")
    found = ran(chirp, arithmetic="fixed", observables=())
    assert (found.arithmetic, found.status) == ("mpfr", "finished")
    assert "range of fixed" in found.fallback


@pytest.mark.parametrize("name", ["fixed", "mpfr", "float64"])
def test_an_interrupted_run_goes_on_with_its_clock(name: str, tmp_path: Path) -> None:
    class Interrupting:
        left = 3

        def __call__(self, done: int) -> None:
            self.left -= 1
            if self.left == 0:
                raise KeyboardInterrupt

    keeper = Keeper(tmp_path, "task")
    with pytest.raises(KeyboardInterrupt):
        ran("lie2", name, progress=Interrupting(), keeper=keeper)
    again, whole = ran("lie2", name, keeper=keeper), ran("lie2", name)
    assert again.values == whole.values


def test_the_states_of_a_run_are_at_their_times() -> None:
    found = verify.run(PENDULUM, "lie2", q=1, p=0, step_size=H, steps=4, t0=T0, digits=20)
    assert found.orbit.texts("t") == ("1/3", "103/300", "53/150", "109/300", "28/75")
    one = verify.run(PENDULUM, "lie2", q=1, p=0, step_size=H, steps=1, t0=T0, digits=20)
    assert found.orbit.texts("delta_j")[0] == one.orbit.texts("lambda")[1]
    p, q, t = (Fraction(found.orbit.texts(n)[-1]) for n in ("p", "q", "t"))
    energy = p**2 / 2 - (1 + Fraction(float(own.cos(float(2 * t)))) / 2) * Fraction(
        float(own.cos(float(q)))
    )
    first = -(1 + Fraction(float(own.cos(float(2 * T0)))) / 2) * Fraction(float(own.cos(1)))
    assert abs(energy - first - Fraction(found.orbit.texts("energy_error")[-1])) < Fraction(
        1, 10**12
    )


def test_where_delta_j_depends_on_time_alone_it_is_run() -> None:
    """H = p²/2 + f(t) q²/2 has a ΔJ of lie2 without p and q, and yet Λ is no power."""
    found = verify.run("p**2/2 + t*q**2/2", "lie2", q=1, p=0, step_size="0.1", steps=20, digits=20)
    assert found.exact == ()
    product = Fraction(1)
    for k in range(20):
        t, h = Fraction(k, 10), Fraction(1, 10)
        a, b, c, d = 1 - h**2 * t / 2, -h * t - h**2 / 2, h, 1 - h**2 * t / 2
        product *= a * d - b * c
    value = found.values["lambda"]
    assert abs(Fraction(value.value) - (product - 1)) <= Fraction(value.bound)


# -- what costs nothing, and what is refused -------------------------------------------------------


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_kernel_of_an_h_without_t_has_no_clock(name: str) -> None:
    plain = Hamiltonian.parse("p**2/2 - cos(q)")
    kernel = kernel_for(plain, "lie2", number_systems.get(name, 20), frozenset({"lambda"}))
    assert not kernel.timed
    assert not {"step", "clock", "clock_rest"} & set(kernel.state_names)
    assert "t0" not in kernel.source


def test_a_pole_in_t_that_a_step_passes_over_is_named_with_its_step() -> None:
    opened = Hamiltonian.parse("p**2/2 + q**2/(2*(1 - t))")
    check_times(opened, Fraction(0), Fraction(3, 100), 33)
    for steps in (34, 10**9):
        with pytest.raises(InputError, match=r"at step 34, t = 0.99 … 1.02"):
            check_times(opened, Fraction(0), Fraction(3, 100), steps)
    check_times(opened, Fraction(101, 100), Fraction(3, 100), 10**9)
    with pytest.raises(InputError, match="at step 34"):
        verify.run("p**2/2 + q**2/(2*(1 - t))", "lie2", q=1, p=0, step_size="0.03", steps=50)
    with pytest.raises(InputError, match="q, p, t=1, 0, 0"):
        verify.run("p**2/2 + q**2*log(t)", "lie2", q=1, p=0, step_size="0.03", steps=50)


def test_smooth_in_all_times_is_seen_in_few_looks() -> None:
    always = Hamiltonian.parse("p**2/2 + q**2/(3/2 + cos(t))")
    check_times(always, Fraction(0), Fraction(1, 1000), 10**7)


@pytest.mark.parametrize("t0", ["0", "1000000"])
def test_in_two_degrees_far_in_time_fixed_takes_periods_off_and_gives_what_mpfr_does(
    t0: str,
) -> None:
    """Of an H that is periodic in t, and would leave the format otherwise."""
    formula = "p1**2/2 + p2**2/2 - cos(q1)*(1 + cos(t)/3) + (q1 - q2)**2/2"
    fixed, mpfr = (
        run(Hamiltonian.parse(formula), "lie2", q=["1/7", "1/8"], p=["1/10", "1/5"], t0=t0,
            step_size="1/10", steps=400, arithmetic=name, digits=15)
        for name in ("fixed", "mpfr")
    )  # fmt: skip
    assert (fixed.arithmetic, mpfr.arithmetic) == ("fixed", "mpfr")
    assert {n: v.value for n, v in fixed.values.items()} == {
        n: v.value for n, v in mpfr.values.items()
    }
