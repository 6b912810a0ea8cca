"""What ΔJ, MSE and Λ of Eq. 14–16 measure."""

from fractions import Fraction

import sympy

from verify.algebra.symbols import P, Q
from verify.arithmetic.exact import decimal, text
from verify.papers import exact_maps
from verify.papers.argument import NUMBERS, Argument, ArgumentTexts, Check, Step, vanishes
from verify.papers.differential_polynomials import flow_of_every_hamiltonian
from verify.papers.elementary_identities import product_of_determinants
from verify.papers.lie_derivative_scheme import examples

_TEXTS = ArgumentTexts(__file__)

_H = Fraction(1, 10)
_START = exact_maps.RationalPoint(Fraction(1, 2), Fraction(1))


def eq_14(highest: int = 5, eta: int = 5) -> Argument:
    """Prove that the exact flow has det 1; checked up to h^highest by lie`eta` for a generic H."""
    return _TEXTS.proof("eq_14", check_flow=_check_flow(highest, eta))


def _check_flow(highest: int, eta: int) -> Check:
    flow = flow_of_every_hamiltonian(highest + 1)
    return vanishes(
        f"the coefficients of h … `h^{highest}` in ΔJ of the flow of a generic H",
        *flow.delta_j_gaps(eta)[:highest],
    )


def eq_15(true: int = 1, steps: int = 3) -> Argument:
    """Prove that MSE is the mean of (det J − 1)², 1 the true value; `true` is used in its place."""
    squares = mean_of_squares(true, steps)
    return _TEXTS.proof("eq_15", check_flow=_check_flow(3, 3), squares=squares)


def mean_of_squares(true: int = 1, steps: int = 3) -> Check:
    """Check the closed form of MSE against det J from its entries; `true` stands for 1."""
    scheme, point, dets = examples.duffing_step(), _START, []
    for _ in range(steps):
        # det J from the entries of J, and not from the closed form of ΔJ, which is under test.
        a, b, c, d = exact_maps.jacobian(scheme, point, _H)
        dets.append(a * d - b * c)
        point = exact_maps.next_point(scheme, point, _H)
    mean = sum(((x - true) ** 2 for x in dets), Fraction(0)) / steps
    mse = exact_maps.areas(scheme, _START, _H, steps).mse
    return Check(
        f"Duffing, δ = 1, lie2, h = {text(_H)}, (p, q) = {_START}, N = {steps}: the mean of (det J "
        f"− {true})², det J from its entries, and the MSE by the closed form",
        mean == mse,
        f"`{decimal(mean, 4)}` and `{decimal(mse, 4)}`",
        NUMBERS,
    )


def eq_15_sum(steps: int = 2) -> Argument:
    """Refute that Eq. 15 is the sum of the squares, which is N times as much."""
    run_areas = exact_maps.areas(examples.duffing_step(), _START, _H, steps)
    total = sum((x * x for x in run_areas.delta_j), Fraction(0))
    differ = Check(
        f"Duffing, δ = 1, lie2, h = {text(_H)}, (p, q) = {_START}, N = {steps}: Σ `ΔJ_k`² and MSE",
        total != run_areas.mse and total == steps * run_areas.mse,
        f"`{decimal(total, 4)}` and `{decimal(run_areas.mse, 4)}`",
        NUMBERS,
    )
    return _TEXTS.refutation("eq_15_sum", differ=differ)


def criterion_4(stray: Fraction = Fraction(0)) -> Argument:
    """Prove that 1 + Λ is the determinant of the map of all N steps; `stray` is added to it."""
    return _TEXTS.proof("criterion_4", determinant_of_all_steps=determinant_of_all_steps(stray))


def determinant_of_all_steps(stray: Fraction = Fraction(0)) -> list[Step]:
    """Show that 1 + Λ is the determinant of the map of all steps."""
    return _TEXTS.steps(
        "determinant_of_all_steps",
        product_of_determinants=product_of_determinants(),
        composition=_composition(2, stray),
    )


def _composition(steps: int, stray: Fraction) -> Check:
    scheme = examples.duffing_step()
    # The composition is differentiated as a whole; the chain rule is what is tested.
    entries = [
        sympy.diff(x, z) for x in exact_maps.run_symbolically(scheme, (P, Q), steps) for z in (P, Q)
    ]
    a, b, c, d = (exact_maps.value(x, _START, _H) for x in entries)
    det, lam = a * d - b * c + stray, exact_maps.areas(scheme, _START, _H, steps).lam
    return Check(
        f"Duffing, δ = 1, lie2, h = {text(_H)}, (p, q) = {_START}: the determinant of {steps} "
        "steps, composed and then differentiated, and 1 + Λ",
        det == 1 + lam,
        f"`{decimal(det, 8)}` and `{decimal(1 + lam, 8)}`, exactly equal",
        NUMBERS,
    )


# -- “the system with a smaller cumulative error” --------------------------------------------------


def smaller_lambda() -> Argument:
    """Prove that |Λ| is the relative change of areas after all steps."""
    return _TEXTS.proof("smaller_lambda", determinant_of_all_steps=determinant_of_all_steps())


def smaller_lambda_each_step(
    to_and_fro: examples.ExampleMap = examples.TO_AND_FRO,
    friction: examples.ExampleMap = examples.FRICTION,
) -> Argument:
    """Refute that a smaller |Λ| means smaller changes of area in every step."""
    pairs = [
        (one.run(n), other.run(n))
        for n in to_and_fro.steps
        for one, other in [(to_and_fro, friction)]
    ]
    worse = [
        abs(a.lam) < abs(b.lam) and min(map(abs, a.delta_j)) > b.largest and a.mse > b.mse
        for a, b in pairs
    ]
    compared = Check(
        f"N = {', '.join(map(str, to_and_fro.steps))}: |Λ| is smaller, the least |`ΔJ_k`| and the "
        "MSE are greater",
        all(worse),
        "exactly",
        NUMBERS,
    )
    return _TEXTS.refutation(
        "smaller_lambda_each_step",
        to_and_fro_changes=to_and_fro.changes(),
        to_and_fro_check=to_and_fro.check(),
        friction_changes=friction.changes(),
        friction_check=friction.check(),
        compared=compared,
    )
