"""The statements of a kernel's loop that use the values of a step: observables, then z ← z + Δz.

The statements of an observable are in its file of `verify.observables`. Two more may be requested:
`extremes`, the least and greatest ΔJ and Λ of one call's steps; and `tangent`, which carries the
tangent map along, for a rigorous bound (`verify.kernels.step.tangent_map`). ΔJ is the area error of
a step, and Λ = Π (1 + ΔJ) − 1.

If an arithmetic's numbers have an absolute precision (fixed point), D = 2^s ΔJ and its sums are
carried, so that they keep their significant digits however small h is. D is evaluated as κ times
ΔJ/h^r with κ = 2^s h^r and the greatest possible r. The unscaled Λ is carried too, as `part`, since
it is a factor of a product.

A compensated kernel adds the increments to the state, and ΔJ to its sums, in twice the working
precision (Knuth's two-sum). Then the rounding errors of the increments remain, which are smaller by
a factor of about h. The difference from the plain kernel estimates the plain kernel's rounding
error.
"""

from collections.abc import Set

from verify import observables as kinds
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.step import tangent_map
from verify.kernels.step.computation import Computation
from verify.kernels.step.lowering import Lowering
from verify.observables.observable import Need

EXTREMES, TANGENT = "extremes", "tangent"


def needs_of(requests: Set[str]) -> set[Need]:
    """Return the quantities of a step that the requested observables need."""
    needs: set[Need] = {each.needs for each in kinds.select(requests) if each.needs}
    return needs | ({"delta_j"} if EXTREMES in requests else set())


def integrals_of(requests: Set[str]) -> tuple[str, ...]:
    """Return the functions whose least and greatest values are carried; the k-th as `e{k}_low` and
    `e{k}_high`, from `e{k}_start`."""
    spans = {x.integral for x in kinds.select(requests) if x.integral and not x.at_end}
    return tuple(sorted(spans))


def is_scaled(requests: Set[str]) -> bool:
    """Return True if any requested quantity is carried with the factor 2^s."""
    return EXTREMES in requests or any(observable.shift for observable in kinds.select(requests))


class Statements:
    """A writer of the statements.

    `state` lists the numbers that they carry from step to step: (name, kind, start value); a start
    value is a number, or a name among the run's inputs.
    """

    def __init__(
        self,
        computation: Computation,
        lowering: Lowering,
        arithmetic: Arithmetic,
        observables: Set[str],
        compensated: bool,
    ) -> None:
        self.computation, self.lowering, self.arithmetic = computation, lowering, arithmetic
        self.observables, self.compensated = observables, compensated
        self.state: list[tuple[str, str, int | str]] = [
            (x, "wide", x) for x in computation.coordinates
        ]
        self.value = {name: lowering.name(index) for name, index in computation.outputs.items()}
        self.entries = [lowering.name(index) for index in computation.defect.values()]

    def all_lines(self) -> list[str]:
        """Return all statements: those of observables and of the tangent map read the state before
        the step, those of z ← z + Δz come last."""
        requests = self.observables
        lines = [f"dj = {self.value['dj']}"] if "delta_j" in needs_of(requests) else []
        for observable in kinds.select(requests):
            lines += observable.lines(self)
        if EXTREMES in requests:
            lines += self.product()
            for name, kind in (("dj", "wide"), ("lam", "sum")):
                for end, order in ((f"{name}_low", "<"), (f"{name}_high", ">")):
                    self.carry(end, 0, kind)
                    lines.append(self.keep_extreme(end, name, order, reset="k == 0 or "))
        if self.computation.tangent:
            coordinates, is_canonical = self.computation.coordinates, self.computation.canonical
            for name, start in tangent_map.initial_values(coordinates, is_canonical):
                self.carry(name, start, "float")
            change = [
                self.computation.tangent.lowering.name(index)
                for index in self.computation.tangent.change
            ]
            lines += tangent_map.statements(change, coordinates, is_canonical)
        for name in self.computation.coordinates:
            lines += self.accumulate(name, self.value[f"d{name}"])
        return lines

    def product(self) -> list[str]:
        """Return the statements Λ ← Λ + ΔJ + Λ ΔJ; none if another observable has them already."""
        if self.carries("lam"):
            return []
        lines = self.sum_up("lam", "dj + lam * dj")
        product = "lam"
        # In fixed point `lam` has the factor 2^s, which a factor of a product must not have: `part`
        # is the unscaled Λ.
        if self.arithmetic.absolute:
            self.carry("part", 0)
            product = "part"
            lines = [
                "grown = dj + dj * part",
                "part = part + shifted(grown, shift)",
                "lam = lam + grown",
            ]
        if self.computation.tangent:
            for end, relation in (("least", "<"), ("most", ">")):
                self.carry(end, 0)
                lines.append(f"if {product} {relation} {end}: {end} = {product}")
        return lines

    def matrix(self) -> list[str]:
        """Return the statements M ← M + K M; none if another observable has them already."""
        lines: list[str] = []
        for name in self.computation.matrix:
            if not self.carries(name):
                _, a, b = name.split("_")
                self.carry(name, int(a == b))
                lines += self.accumulate(name, self.value[f"d{name}"])
        return lines

    def largest(self, name: str, term: str, kind: str = "wide") -> list[str]:
        """Return the statements that keep the greatest |term| in `name`, which ends in `top`."""
        if not self.carries(name):
            self.carry(name, 0, kind)
        size = f"{name.removesuffix('top')}size"
        return [f"{size} = abs({term})", self.keep_extreme(name, size, ">")]

    def extremes(self, integral: str) -> list[str]:
        """Return the statements that keep the least and the greatest value of a function."""
        name = f"e{integrals_of(self.observables).index(integral)}"
        for end in ("low", "high"):
            self.carry(f"{name}_{end}", f"{name}_start")
        value = self.value[name]
        pairs = ((f"{name}_low", "<"), (f"{name}_high", ">"))
        return [self.keep_extreme(end, value, order) for end, order in pairs]

    def keep_extreme(self, name: str, candidate: str, order: str, reset: str = "") -> str:
        """Return the statement that makes `name` the least (for "<") or greatest (for ">") of its
        value and `candidate`.

        `reset`: the condition, followed by `or`, under which `name` becomes `candidate`.
        """
        choose, opposite = {"<": ("minimum", ">="), ">": ("maximum", "<=")}[order]
        if choose not in self.arithmetic.functions:
            return f"if {reset}{candidate} {order} {name}: {name} = {candidate}"
        # Of two balls neither need be certainly the greater: the extreme may be a third ball.
        extreme = f"{choose}({candidate}, {name})"
        value = f"{candidate} if k == 0 else {extreme}" if reset else extreme
        return f"if {reset}not {candidate} {opposite} {name}: {name} = {value}"

    def carry(self, name: str, start: int | str, kind: str = "wide") -> None:
        """Add a number to the state: its name, its start value, and its kind."""
        self.state.append((name, kind, start))

    def carries(self, name: str) -> bool:
        """Return True if a number of that name is carried."""
        return any(name == state_name for state_name, _, _ in self.state)

    def sum_up(self, name: str, increment: str) -> list[str]:
        """Carry a sum that begins with 0, and return its statements `name += increment`."""
        self.carry(name, 0, "sum")
        return self.accumulate(name, increment)

    def accumulate(self, name: str, increment: str) -> list[str]:
        """Return the statements `name += increment`, by Knuth's two-sum if the kernel is
        compensated."""
        if not self.compensated:
            return [f"{name} = {name} + ({increment})"]
        # Two-sum: `{name}_rest` is the exact error of the addition, whichever operand is larger.
        self.carry(f"{name}_rest", 0)
        return [
            f"add = {name}_rest + ({increment})",
            f"total = {name} + add",
            f"rest = total - {name}",
            f"{name}_rest = ({name} - (total - rest)) + (add - rest)",
            f"{name} = total",
        ]
