"""Of H = H1(p1, q1) + H2(p2, q2) + … the run is that of each plane by itself, and so is S.

Asked of H without its couplings. J has the blocks that the plane's own maps have: S has ΔJ of each
plane on its diagonal and nothing else, det J is their product, and W_N is Λ of each. By balls; of a
step that solves equations by runs of 60 digits.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.oracles.ball_steps import BITS, BallState, ball_steps, defect, unlike
from verify.exploration.oracles.mpfr_runs import RunInDegrees, must_agree
from verify.exploration.property import Violation, only_if
from verify.exploration.sample_in_degrees import SampleInDegrees
from verify.hamiltonians.hamiltonian import Hamiltonian

_IN, _OF_EQUATIONS = 2, 4  # one in so many samples
_MOST_STEPS = 3
Part = tuple[Hamiltonian, dict[str, Fraction]]  # H_k as one of the plane, and its start


def holds_in_degrees(sample: SampleInDegrees) -> None:
    parts = list(_parts(sample))
    together = Hamiltonian(sympy.Add(*(_of_degree(sample, k) for k in range(len(parts)))))
    only_if(together.coordinates == sample.hamiltonian.coordinates and sample.brief)
    only_if(sample.is_turn(_IN if sample.scheme.explicit else _OF_EQUATIONS))
    if not sample.scheme.explicit:
        _by_runs(sample, together, parts)
        return
    steps = min(sample.steps, _MOST_STEPS)
    step = sample.scheme.step_map(together)
    start = sample.start if together.time_dependent else {
        name: x for name, x in sample.start.items() if name != "t"
    }  # fmt: skip
    whole = ball_steps(step, start, steps)[-1].sharp()
    planes = [_end_in_plane(sample, part, steps) for part in parts]
    with working_precision(BITS):
        _must_be_product(whole, planes)


def _parts(sample: SampleInDegrees) -> Iterator[Part]:
    """The planes; Silent where a degree has no term of its own."""
    n = sample.hamiltonian.degrees
    for k in range(n):
        expression = _of_degree(sample, k)
        only_if(bool(expression.free_symbols & _own(sample, k)))
        p, q = (sample.hamiltonian.coordinates[half + k] for half in (0, n))
        put = {symbol(p): symbol("p"), symbol(q): symbol("q")}
        yield Hamiltonian(expression.xreplace(put)), {"p": sample.p[k], "q": sample.q[k]}


def _own(sample: SampleInDegrees, k: int) -> set[sympy.Symbol]:
    names = sample.hamiltonian.coordinates
    return {symbol(names[k]), symbol(names[len(names) // 2 + k])}


def _of_degree(sample: SampleInDegrees, k: int) -> sympy.Expr:
    """The terms of H that have coordinates of degree k and of no other."""
    every, own = set(map(symbol, sample.hamiltonian.coordinates)), _own(sample, k)
    terms = sympy.Add.make_args(sample.hamiltonian.exact)
    return sympy.Add(*(x for x in terms if x.free_symbols & own and not
                       x.free_symbols & (every - own)))  # fmt: skip


def _end_in_plane(sample: SampleInDegrees, part: Part, steps: int) -> BallState:
    hamiltonian, point = part
    start = {**point, "h": sample.step_size}
    if hamiltonian.time_dependent:
        start["t"] = sample.t0
    return ball_steps(sample.scheme.step_map(hamiltonian), start, steps)[-1].sharp()


def _must_be_product(whole: BallState, planes: Sequence[BallState]) -> None:
    n, form = len(planes), defect(whole.matrix)
    for k, plane in enumerate(planes):
        for letter, half in (("p", 0), ("q", n)):
            name, wanted = f"{letter}{k + 1}", plane.point[letter]
            if not whole.point[name].overlaps(wanted):
                raise Violation(f"{name} is {unlike(whole.point[name], wanted)}, in its plane")
            for j in range(2 * n):
                if j % n != k and not whole.matrix[half + k, j].contains(0):
                    raise Violation(f"J of the run has an entry of {name} by another degree")
        if not form[k, n + k].overlaps(plane.product - 1):
            told = unlike(form[k, n + k], plane.product - 1)
            raise Violation(f"W's entry dp{k + 1}∧dq{k + 1} is {told}, Λ of its plane")
    product = planes[0].product
    for plane in planes[1:]:
        product *= plane.product
    found = whole.matrix.det()
    if not found.overlaps(product):
        raise Violation(f"Π det J is {unlike(found, product)}, the product of the planes'")


def _by_runs(sample: SampleInDegrees, together: Hamiltonian, parts: Sequence[Part]) -> None:
    only_if(sample.short)
    found = RunInDegrees(together, sample.point, sample).end
    for k, (hamiltonian, point) in enumerate(parts, start=1):
        plane = RunInDegrees(hamiltonian, point, sample).end
        own = {letter: found[f"{letter}{k}"] for letter in "pq"}
        must_agree(own, plane, Fraction(1))
