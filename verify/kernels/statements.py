"""What a kernel's loop does with the values of a step: observables, then the step, as statements.

What an observable adds is in its file of `verify.observables`. Beside them may be asked:
`extremes`, the least and greatest ΔJ and Λ of one call's steps; and `tangent`, which carries the
tangent map along, for a rigorous bound (`verify.kernels.step.tangent_map`).

Where an arithmetic's numbers have an absolute precision (fixed point), D = 2^s ΔJ is carried, and
so are its sums, so that they keep their significant digits however small h is; it is evaluated from
ΔJ/h^r, r as great as can be, with κ = 2^s h^r in its coefficients. Λ itself is carried beside them
as `part`, since it multiplies.

A compensated kernel adds the increments to the state, and ΔJ to its sums, in twice the working
precision (Knuth's two-sum): what remains is the rounding of the increments, smaller by a factor of
about h. Its difference from the plain kernel estimates the plain kernel's rounding error.
"""

from collections.abc import Set

from verify import observables as kinds
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.step import tangent_map
from verify.kernels.step.computation import Computation
from verify.kernels.step.lowering import Lowering
from verify.observables.observable import Need

EXTREMES, TANGENT = "extremes", "tangent"


def needs_of(asked: Set[str]) -> set[Need]:
    """What of a step is needed for the observables among what is asked."""
    needs: set[Need] = {each.needs for each in kinds.among(asked)}
    return needs | ({"delta_j"} if EXTREMES in asked else set())


def is_scaled(asked: Set[str]) -> bool:
    """Whether anything that is asked is carried 2^s times."""
    return EXTREMES in asked or any(each.shift for each in kinds.among(asked))


class Statements:
    """Writes them; `state` has what they carry from step to step: name, kind of number, and the
    value it starts with, a number or a name of the run's own."""

    def __init__(
        self,
        made: Computation,
        lowering: Lowering,
        arithmetic: Arithmetic,
        observables: Set[str],
        compensated: bool,
    ) -> None:
        self.made, self.lowering, self.arithmetic = made, lowering, arithmetic
        self.observables, self.compensated = observables, compensated
        self.state: list[tuple[str, str, int | str]] = [(x, "wide", x) for x in made.coordinates]
        self.value = {name: lowering.name(index) for name, index in made.outputs.items()}
        self.entries = [lowering.name(index) for index in made.defect.values()]

    def written(self) -> list[str]:
        """All of them, in their order."""
        asked = self.observables
        lines = [f"dj = {self.value['dj']}"] if "delta_j" in needs_of(asked) else []
        for each in kinds.among(asked):
            lines += each.lines(self)
        if EXTREMES in asked:
            lines += self.product()
            for name, kind in (("dj", "wide"), ("lam", "sum")):
                for end, order in ((f"{name}_low", "<"), (f"{name}_high", ">")):
                    self.carry(end, 0, kind)
                    lines.append(self.keep_extreme(end, name, order, first="k == 0 or "))
        if self.made.tangent:
            for name, start in tangent_map.carried(self.made.coordinates):
                self.carry(name, start, "float")
            change = [self.made.tangent.lowering.name(index) for index in self.made.tangent.change]
            lines += tangent_map.statements(change, self.made.coordinates)
        for name in self.made.coordinates:
            lines += self.accumulate(name, self.value[f"d{name}"])
        return lines

    def product(self) -> list[str]:
        """Λ ← Λ + ΔJ + Λ ΔJ, once."""
        if self.carries("lam"):
            return []
        lines = self.sum_up("lam", "dj + lam * dj")
        product = "lam"
        if self.arithmetic.absolute:
            self.carry("part", 0)
            product = "part"
            lines = [
                "grown = dj + dj * part",
                "part = part + shifted(grown, shift)",
                "lam = lam + grown",
            ]
        if self.made.tangent:
            for end, relation in (("least", "<"), ("most", ">")):
                self.carry(end, 0)
                lines.append(f"if {product} {relation} {end}: {end} = {product}")
        return lines

    def largest(self, name: str, term: str, kind: str = "wide") -> list[str]:
        """The statements that keep the greatest |term| under a name that ends in top."""
        if not self.carries(name):
            self.carry(name, 0, kind)
        size = f"{name.removesuffix('top')}size"
        return [f"{size} = abs({term})", self.keep_extreme(name, size, ">")]

    def keep_extreme(self, name: str, of: str, order: str, first: str = "") -> str:
        """The statement that makes `name` the least or greatest of what it was and of `of`."""
        choose, opposite = {"<": ("minimum", ">="), ">": ("maximum", "<=")}[order]
        if choose not in self.arithmetic.functions:
            return f"if {first}{of} {order} {name}: {name} = {of}"
        # Balls, of which neither may be certainly the greater: then the extreme is a third ball.
        either = f"{choose}({of}, {name})"
        value = f"{of} if k == 0 else {either}" if first else either
        return f"if {first}not {of} {opposite} {name}: {name} = {value}"

    def carry(self, name: str, start: int | str, kind: str = "wide") -> None:
        """Adds to the state: its name, the value it starts with, and its kind of number."""
        self.state.append((name, kind, start))

    def carries(self, name: str) -> bool:
        """Whether it is carried."""
        return any(name == carried for carried, _, _ in self.state)

    def sum_up(self, name: str, increment: str) -> list[str]:
        """The statements `name += increment` of a sum that begins with 0."""
        self.carry(name, 0, "sum")
        return self.accumulate(name, increment)

    def accumulate(self, name: str, increment: str) -> list[str]:
        """The statements `name += increment`; compensated (Kahan) where the kernel is."""
        if not self.compensated:
            return [f"{name} = {name} + ({increment})"]
        self.carry(f"{name}_rest", 0)
        return [
            f"add = {name}_rest + ({increment})",
            f"total = {name} + add",
            f"rest = total - {name}",
            f"{name}_rest = ({name} - (total - rest)) + (add - rest)",
            f"{name} = total",
        ]
