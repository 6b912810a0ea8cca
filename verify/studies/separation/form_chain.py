"""The chain of every entry of W, in n degrees of freedom.

W_N = MᵀΩM − Ω, M the product of N steps' Jacobians, is to n degrees what Λ is to one. Each of its
n (2n − 1) entries above the diagonal has a chain (`verify.studies.separation.chain`) of its own:

    W₀  exact arithmetic at the exact inputs
    W₁  exact arithmetic at the inputs rounded to float64
    W₂  the states that float64 steps to, bit by bit; the Jacobians at them and W exactly
    W₃  the Jacobians, or S, as float64 computes them, bit by bit; their products and W exactly
    W₄  products and W in float64 too, `w_working`

    W₄ = W₀ + (W₁ − W₀) + (W₂ − W₁) + (W₃ − W₂) + (W₄ − W₃)
       = truncation + input + trajectory + derivatives + product,

an equation of rationals, entry by entry. Where H depends on time `clock` stands after W₁, as in one
degree of freedom. What is known is not run: where S ≡ 0 is proved, W₀, W₁ and W₂ are exactly 0, and
so are all links of the closed form; where every input is a float64, W₁ = W₀; after one step
W₂ = W₁.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify import arithmetic as number_systems
from verify.arithmetic import AUTO
from verify.errors import InputError
from verify.execution.keeping import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.chunked_loop import ENTRIES
from verify.kernels.step.computation import step_map_of
from verify.kernels.stepping import KernelRun, Outcome
from verify.lockstep import Course
from verify.runs.estimated import working_digits
from verify.studies.separation.chain import Chain, lacking
from verify.studies.separation.form_run import POINTS, FormRun, FormWorking, Links, Size, links_of
from verify.studies.separation.links import AsLink, LinksOnDemand, last_system
from verify.studies.separation.mixed_run import Advance
from verify.studies.separation.working import exact_link

PARTS = ("input", "trajectory", "derivatives", "product")  # of rounding, in the chain's order
PARTS_IN_TIME = ("input", "clock", "trajectory", "derivatives", "product")
_CANCELLED = 20  # digits that the differences between links cancel
_PRODUCTS = 20  # and those that MᵀΩM − Ω does
_HIDDEN = 25  # digits further below the greatest entry a part is taken for noise


@dataclass(frozen=True)
class FormChains:
    """The chains of the plain way and of the closed form, one for each entry above the diagonal.

    `arithmetic` stood for exact arithmetic; `sizes`: of M at the checkpoints.
    """

    plain: tuple[Chain, ...]
    closed_form: tuple[Chain, ...]
    sizes: tuple[Size, ...]
    arithmetic: str
    seconds: float

    @property
    def marks(self) -> tuple[int, ...]:
        """The numbers of steps at the checkpoints."""
        return self.plain[0].marks


def form_chains(
    hamiltonian: Hamiltonian,
    scheme: str,
    start: dict[str, Fraction],
    steps: int,
    digits: int,
    arithmetic: str = AUTO,
    advance: Advance = lambda _: None,
    keeper: Keeper = NOTHING,
) -> Course[FormChains]:
    """Of a scheme's run from exact inputs, every part of every entry of W to so many digits, where
    that can be had; arguments as in `verify.studies.separation.chain.separated_chains`.

    Raises Stopped where W has no value, and InputError for a scheme that solves equations.
    """
    asked = frozenset({"symplectic_defect", ENTRIES})
    kernel_run = KernelRun(hamiltonian, scheme, start, steps, asked, 0, keeper, sections=POINTS)
    if kernel_run.implicit:
        problem = "solves equations; in n degrees of freedom its Jacobian is not followed"
        raise InputError("scheme", scheme, problem)
    links = _FormLinks(kernel_run, arithmetic, digits + _CANCELLED, advance)
    plain, closed = yield from links.to_digits(
        links.chains, lambda found: _lacking((*found[0], *found[1]), digits)
    )
    working = yield from links.working()
    return FormChains(plain, closed, working.sizes, links.arithmetic, links.seconds)


def _lacking(chains: Sequence[Chain], digits: int) -> list[int]:
    """How many digits each link lacks, for the entry that lacks most."""
    largest = max(abs(chain.final(name)[0]) for chain in chains for name in chain.quantities)
    least = largest / Fraction(10) ** (digits + _HIDDEN)
    return lacking(chains, digits, least)


class _FormLinks(LinksOnDemand[Links, FormWorking]):
    """The links of all entries of W."""

    observable = "symplectic_defect"
    points = POINTS

    def __init__(
        self, kernel_run: KernelRun, arithmetic: str, digits: int, advance: Advance
    ) -> None:
        super().__init__(kernel_run, arithmetic, digits, advance)
        self.digits["beside"] += _PRODUCTS

    def of_proof(self, name: str) -> Links | None:
        """0, where S ≡ 0."""
        exact = self.kernel_run.hamiltonian
        if not step_map_of(exact, self.kernel_run.scheme).preserves_area:
            return None
        nothing, size = exact_link([Fraction(0)] * len(self.marks), "S ≡ 0"), len(exact.coordinates)
        return (nothing,) * (size * (size - 1) // 2)

    def chains(self) -> Course[tuple[tuple[Chain, ...], tuple[Chain, ...]]]:
        """Those of the plain way and of the closed form."""
        shared = yield from self.shared()
        working = yield from self.working()
        parts = PARTS_IN_TIME if self.kernel_run.hamiltonian.time_dependent else PARTS

        def chains(*links: Links) -> tuple[Chain, ...]:
            each = zip(*shared, *links, strict=True)
            return tuple(Chain(self.marks, own, parts) for own in each)

        first = shared[0]
        closed = working.closed_factors or first, working.closed_form or first
        return chains(working.factors, working.plain), chains(*closed)

    def beside(self) -> Course[FormWorking]:
        """In what has every range and function."""
        follow = self.proved("first") is None and self.kernel_run.steps > 1
        digits = working_digits(self.digits["beside"], self.kernel_run.steps)
        asked = number_systems.get(self.arithmetic, digits)
        own = last_system().make(digits) if asked.absolute or asked.radius else asked
        run = FormRun(self.kernel_run, self.inputs, follow)
        return (yield from run.step_through(own, self.advance))

    def read(self, run: Outcome, last: Fraction, as_link: AsLink) -> Links:
        """Each entry at every checkpoint; `last` is of the greatest alone."""
        names = [n for n in run.tangents[0] if n.startswith("w_")]
        trail = [tuple(note[n] for n in names) for note in run.tangents]
        return links_of(trail, as_link)
