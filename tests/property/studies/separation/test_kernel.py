"""What a mixed kernel carries from step to step, and parts of Λ far below the others."""

from fractions import Fraction

from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.separations import KNOWN, SHORT, bent, separated, starts, step_sizes
from tests.helpers.stepping.exact_separation import links
from verify import arithmetic as number_systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.studies.separation.chain import QUANTITIES, Chain
from verify.studies.separation.determinants import WORKING, Determinants
from verify.studies.separation.mixed_kernel import mixed_kernel
from verify.studies.separation.mixed_run import MixedRun, Stopped

few = drawn(10)


@few
@given(
    st.sampled_from(KNOWN),
    st.sampled_from(["lie1", "lie2", "lie3", "symplectic-euler"]),
    starts,
    starts,
    step_sizes,
    st.integers(1, 60),
    st.booleans(),
)
def test_a_region_holds_all_states_that_delta_j_was_taken_at_and_no_more(
    text: str, scheme: str, p: Fraction, q: Fraction, h: Fraction, steps: int, follow: bool
) -> None:
    """And the greatest |Λ| is that of a step: a checkpoint is made at each."""
    run = KernelRun(Hamiltonian.parse(text), scheme, {"p": p, "q": q, "h": h}, steps, WORKING, 10)
    working, exact = MixedRun(Determinants(), run, follow), number_systems.get("mpfr", 25)
    kernel = mixed_kernel(Determinants(), run.hamiltonian, run.scheme, exact, follow)
    try:
        states = [working._first_state(kernel, exact)]
        states += run_alone(working.step_all(exact, lambda _: None)).states
    except Stopped:
        assume(False)
        raise
    assert len(states) == steps + 1
    for name in ("f_p", "f_q"):
        path = [state[name] for state in states]
        assert (
            (f"{name}_low" in kernel.state_names)
            == (f"{name}_high" in kernel.state_names)
            == follow
        )
        for k, state in enumerate(states):
            if follow:
                visited = path[: max(k, 1)]
                assert (state[f"{name}_low"], state[f"{name}_high"]) == (min(visited), max(visited))
    followed = {n for n in ("trajectory", "factors", "closed") if f"w_{n}" in kernel.state_names}
    closed = scheme != "symplectic-euler"  # of which ΔJ is 0 as it is written
    assert kernel.closed == closed
    assert followed == {"factors", *["closed"] * closed, *["trajectory"] * follow}
    for name in followed:
        sizes = [abs(exact.exact(state[f"w_{name}"])) for state in states]
        tops = [exact.exact(state[f"w_{name}_top"]) for state in states]
        assert tops == [max(sizes[: k + 1]) for k in range(len(states))]


sixteenths = st.builds(Fraction, st.integers(1, 16), st.just(16))


@few
@given(
    bent(),
    st.integers(1, 3),
    st.fixed_dictionaries({"p": sixteenths, "q": sixteenths, "h": sixteenths}),
    st.sampled_from("pqh"),
    st.integers(50, 57),
    st.integers(1, 3),
    st.integers(17, 25),
)
def test_an_input_part_far_below_the_others_is_known_to_as_many_digits(
    text: str,
    eta: int,
    start: dict[str, Fraction],
    name: str,
    places: int,
    steps: int,
    digits: int,
) -> None:
    """One input is off from a float64 by 10^−k: Λ₁ − Λ₀ is about so small, and yet not lost."""
    start[name] += Fraction(1, 10**places)
    found, _ = separated(text, f"lie{eta}", start, steps, digits, "mpfr")
    chain: Chain = found.plain
    true = links(text, eta, start, steps)["plain"]
    value, bound = chain.final("input")
    assert abs(value - (true[1] - true[0])) <= bound + SHORT
    # Where Λ's slope is 0 there, as at q = 1/8 for q³ − 3q²/8, it is of the square of that.
    assume(abs(true[1] - true[0]) > Fraction(1, 10 ** (places + 25)))
    assert 0 < bound <= abs(value) / 10**digits / 2


@drawn(4)
@given(st.sampled_from(KNOWN[1:]), st.integers(1, 2), starts, starts, step_sizes, st.integers(1, 6))
def test_balls_in_exact_arithmetics_stead_give_what_mpfr_gives(
    text: str, eta: int, p: Fraction, q: Fraction, h: Fraction, steps: int
) -> None:
    """Also where H has functions, and what stands beside float64 can be no ball."""
    start = {"p": p, "q": q, "h": h}
    one, other = (separated(text, f"lie{eta}", start, steps, 17, n)[0] for n in ("ball", "mpfr"))
    assert (one.arithmetic, other.arithmetic) == ("ball", "mpfr")
    for way in ("plain", "closed_form"):
        x, y = getattr(one, way), getattr(other, way)
        for name in QUANTITIES:
            (a, within), (b, near) = x.final(name), y.final(name)
            assert abs(a - b) <= within + near
