"""The statements of a kernel's loop that use the values of a step: observables, then the step.

The statements of an observable are in its file of `verify.observables`. Two more may be requested:
`extremes`, the least and greatest ΔJ and Λ of one call's steps; and `tangent`, which carries the
tangent map along, for a rigorous bound (`verify.kernels.step.tangent_map`).

If an arithmetic's numbers have an absolute precision (fixed point), D = 2^s ΔJ is carried, and
so are its sums, so that they keep their significant digits however small h is; it is evaluated from
ΔJ/h^r, r as great as can be, with κ = 2^s h^r in its coefficients. Λ itself is carried too, as
`part`, since it multiplies.

A compensated kernel adds the increments to the state, and ΔJ to its sums, in twice the working
precision (Knuth's two-sum): only the rounding of the increments remains, which is smaller by a
factor of about h. Its difference from the plain kernel estimates the plain kernel's rounding error.
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
    needs: set[Need] = {observable.needs for observable in kinds.select(requests)}
    return needs | ({"delta_j"} if EXTREMES in requests else set())


def is_scaled(requests: Set[str]) -> bool:
    """Return True if any requested quantity is carried 2^s times."""
    return EXTREMES in requests or any(observable.shift for observable in kinds.select(requests))


class Statements:
    """Writes the statements; `state` lists the numbers that they carry from step to step: name,
    kind of number, and start value, a number or a name among the run's inputs."""

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
        """Return all statements, in their order."""
        requests = self.observables
        lines = [f"dj = {self.value['dj']}"] if "delta_j" in needs_of(requests) else []
        for observable in kinds.select(requests):
            lines += observable.lines(self)
        if EXTREMES in requests:
            lines += self.product()
            for name, kind in (("dj", "wide"), ("lam", "sum")):
                for end, order in ((f"{name}_low", "<"), (f"{name}_high", ">")):
                    self.carry(end, 0, kind)
                    lines.append(self.keep_extreme(end, name, order, first="k == 0 or "))
        if self.computation.tangent:
            for name, start in tangent_map.initial_values(self.computation.coordinates):
                self.carry(name, start, "float")
            change = [
                self.computation.tangent.lowering.name(index)
                for index in self.computation.tangent.change
            ]
            lines += tangent_map.statements(change, self.computation.coordinates)
        for name in self.computation.coordinates:
            lines += self.accumulate(name, self.value[f"d{name}"])
        return lines

    def product(self) -> list[str]:
        """Return the statements Λ ← Λ + ΔJ + Λ ΔJ, once."""
        if self.carries("lam"):
            return []
        lines = self.sum_up("lam", "dj + lam * dj")
        product = "lam"
        # `lam` is scaled by 2^s here, but a factor of a product must not be: `part` carries the
        # unscaled Λ.
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

    def largest(self, name: str, term: str, kind: str = "wide") -> list[str]:
        """Return the statements that keep the greatest |term| under a name that ends in top."""
        if not self.carries(name):
            self.carry(name, 0, kind)
        size = f"{name.removesuffix('top')}size"
        return [f"{size} = abs({term})", self.keep_extreme(name, size, ">")]

    def keep_extreme(self, name: str, candidate: str, order: str, first: str = "") -> str:
        """Return the statement that makes `name` the least or greatest of its value and
        `candidate`."""
        choose, opposite = {"<": ("minimum", ">="), ">": ("maximum", "<=")}[order]
        if choose not in self.arithmetic.functions:
            return f"if {first}{candidate} {order} {name}: {name} = {candidate}"
        # Balls, of which neither may be certainly the greater: then the extreme is a third ball.
        extreme = f"{choose}({candidate}, {name})"
        value = f"{candidate} if k == 0 else {extreme}" if first else extreme
        return f"if {first}not {candidate} {opposite} {name}: {name} = {value}"

    def carry(self, name: str, start: int | str, kind: str = "wide") -> None:
        """Add a number to the state: its name, its start value, and its kind."""
        self.state.append((name, kind, start))

    def carries(self, name: str) -> bool:
        """Return True if a number of that name is carried."""
        return any(name == state_name for state_name, _, _ in self.state)

    def sum_up(self, name: str, increment: str) -> list[str]:
        """Return the statements `name += increment` of a sum that begins with 0."""
        self.carry(name, 0, "sum")
        return self.accumulate(name, increment)

    def accumulate(self, name: str, increment: str) -> list[str]:
        """Return the statements `name += increment`; compensated (Kahan) if the kernel is."""
        if not self.compensated:
            return [f"{name} = {name} + ({increment})"]
        # Knuth's two-sum: `rest` is the exact error of the addition, whichever operand is larger.
        self.carry(f"{name}_rest", 0)
        return [
            f"add = {name}_rest + ({increment})",
            f"total = {name} + add",
            f"rest = total - {name}",
            f"{name}_rest = ({name} - (total - rest)) + (add - rest)",
            f"{name} = total",
        ]
