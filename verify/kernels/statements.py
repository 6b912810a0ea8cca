"""What a kernel's loop does with the values of a step: observables, then the step, as statements.

Observables: `delta_j_max` max |ΔJ|, `mse` Σ ΔJ² (Eq. 15 before its 1/N), `lambda` Λ (Eq. 16) by
the closed form of ΔJ as Λ ← Λ + ΔJ + Λ ΔJ, `lambda_max` the greatest |Λ| after any step,
`lambda_plain` Π det J the plain way (four entries, their determinant, the product), `extremes` the
least and greatest ΔJ and Λ of one call's steps. In n degrees of freedom also
`symplectic_defect_max`, the greatest |entry| of S, and `symplectic_defect`, W, with the Jacobian M
of all steps so far: W ← W + MᵀSM, M ← J M.

`tangent` carries the tangent map along, for a rigorous bound (`verify.kernels.step.tangent_map`).

Where an arithmetic's numbers have an absolute precision (fixed point), D = 2^s ΔJ is carried, and
so are its sums, so that they keep their significant digits however small h is; it is evaluated from
ΔJ/h^r, r as great as can be, with κ = 2^s h^r in its coefficients. Λ itself is carried beside them
as `part`, since it multiplies.

A compensated kernel adds the increments to the state, and ΔJ to its sums, in twice the working
precision (Knuth's two-sum): what remains is the rounding of the increments, smaller by a factor of
about h. Its difference from the plain kernel estimates the plain kernel's rounding error.
"""

from collections.abc import Mapping, Set

from verify.arithmetic.number_system import Arithmetic
from verify.kernels.step import tangent_map
from verify.kernels.step.computation import Computation
from verify.kernels.step.lowering import Lowering

OBSERVABLES = (
    "delta_j_max", "mse", "lambda", "lambda_max", "lambda_plain", "extremes", "tangent",
)  # fmt: skip
CLOSED_FORM = frozenset({"delta_j_max", "mse", "lambda", "lambda_max", "extremes"})


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

    def written(self) -> list[str]:
        """All of them, in their order."""
        value = {name: self.lowering.name(index) for name, index in self.made.outputs.items()}
        lines: list[str] = []
        asked = self.observables
        if "lambda_plain" in asked:
            self.carry("plain", 1)
            lines.append(f"plain = plain * {value['det']}")
        if asked & CLOSED_FORM:
            lines.append(f"dj = {value['dj']}")
        if {"lambda", "lambda_max", "extremes"} & asked:
            lines += self.product_of_factors()
        if "lambda_max" in asked:
            self.carry("lam_top", 0, "sum")
            lines += ["lam_size = abs(lam)", self.keep_extreme("lam_top", "lam_size", ">")]
        if "mse" in asked:
            lines += self.sum_up("mse", "dj * dj")
        if "delta_j_max" in asked:
            self.carry("top", 0)
            lines += ["size = abs(dj)", self.keep_extreme("top", "size", ">")]
        if "extremes" in asked:
            for name, kind in (("dj", "wide"), ("lam", "sum")):
                for end, order in ((f"{name}_low", "<"), (f"{name}_high", ">")):
                    self.carry(end, 0, kind)
                    lines.append(self.keep_extreme(end, name, order, first="k == 0 or "))
        if "symplectic_defect_max" in asked:
            lines += self.greatest_entry()
        if self.made.tangent:
            for name, start in tangent_map.carried(self.made.coordinates):
                self.carry(name, start, "float")
            change = [self.made.tangent.lowering.name(index) for index in self.made.tangent.change]
            lines += tangent_map.statements(change, self.made.coordinates)
        lines += self.of_matrices(value)
        for name in self.made.coordinates:
            lines += self.accumulate(name, value[f"d{name}"])
        return lines

    def greatest_entry(self) -> list[str]:
        """The greatest |entry| of S."""
        self.carry("s_top", 0)
        lines: list[str] = []
        for index in self.made.defect.values():
            name = self.lowering.name(index)
            lines += [f"s_size = abs({name})", self.keep_extreme("s_top", "s_size", ">")]
        return lines

    def of_matrices(self, value: Mapping[str, str]) -> list[str]:
        """W ← W + MᵀSM and M ← J M, entry by entry; all increments are made before."""
        lines: list[str] = []
        for name, increment in value.items():
            if name.startswith("dw_"):
                lines += self.sum_up(name[1:], increment)
            elif name.startswith("dm_"):
                _, a, b = name.split("_")
                self.carry(name[1:], int(a == b))
                lines += self.accumulate(name[1:], increment)
        return lines

    def product_of_factors(self) -> list[str]:
        """Λ ← Λ + ΔJ + Λ ΔJ."""
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
