"""A vector field evaluated at points other than (p, q), in one ring with them.

A Runge–Kutta stage is H's gradient at a point that is itself made from earlier gradients. Written
out, that is a composition of compositions. Here each point and each gradient is a generator of its
own, of kind `stage`, which is evaluated and differentiated part by part; and each function that H
is made of has a copy with the stage's point inside. So a map is as long as its stages are together,
and a kernel computes it, and its Jacobian by the chain rule, stage by stage.

What is hidden by the names: ΔJ as u_p + v_q + u_p v_q − u_q v_p does not cancel against 1, but its
lower powers of h, which vanish identically in the closed form, vanish here only in the sum. Of
working precision it costs the digits from h², or h, to the order of ΔJ; bounds of runs count that.
"""

from collections.abc import Mapping, Sequence

from verify.algebra.generator import Generator, terms_of
from verify.algebra.ring import Poly, Ring
from verify.hamiltonians.vector_field import VectorField

Point = tuple[Poly, ...]  # p, q, and t where H depends on time
_NAMES = 4  # for a stage: its point and its slope
_DERIVATIVES = 7  # of a name: itself, its two first partial derivatives and its four second ones


class Stages:
    """A ring with room for so many stages of a vector field, and the field at points of it.

    `start` is (p, q) in that ring, or (p, q, t), and `field` the vector field there. `more`:
    generators beside.
    """

    def __init__(self, field: VectorField, count: int, more: int = 0) -> None:
        self.source = field
        functions = len(field.ring.generators) - len(field.ring.variables)
        room = (count + 1) * functions + count * _NAMES * _DERIVATIVES + more
        self.ring = Ring(field.ring.variables, room)
        self.names = ("p", "q", "t") if field.timed else ("p", "q")
        self.start: Point = tuple(map(self.ring.variable, self.names))
        at = self.at(self.start)
        self.field = VectorField(self.ring, at(field.h_p), at(field.h_q))

    def at(self, point: Point) -> "_Moved":
        """Takes elements of the field's own ring to their values at the point."""
        return _Moved(self.source.ring, self.ring, dict(zip(self.names, point, strict=True)))

    def named(self, point: Point) -> Point:
        """Names for p and q; the time is as short as a name."""
        return *map(self.ring.named, point[:2]), *point[2:]

    def slope(self, point: Point) -> Point:
        """(−H_q, H_p) at the point, by names, and 1, by which t moves."""
        at = self.at(self.named(point))
        slope = self.named((at(-self.source.h_q), at(self.source.h_p)))
        return (*slope, self.ring.one)[: len(self.names)]


def chained(field: VectorField, maps: Sequence[Point]) -> tuple[VectorField, Poly, Poly]:
    """The composition of maps (p', q') in the field's ring, first one first, by named points.

    Returns the field in the ring of the result, and the result.
    """
    stages = Stages(field, len(maps))
    p, q, *time = stages.start  # a map has its own clock, which begins with the step
    for p_next, q_next in maps:
        at = stages.at(stages.named((p, q, *time)))
        p, q = at(p_next), at(q_next)
    return stages.field, p, q


class _Moved:
    """Elements of one ring at a point of another one: x ↦ x(P, Q), or x(P, Q, T)."""

    def __init__(self, source: Ring, target: Ring, point: Mapping[str, Poly]) -> None:
        self.target, self.point = target, point
        self.images: dict[int, Poly] = {}
        new: dict[int, Generator] = {}
        for g in source.generators:
            image = self._known(g)
            if image is None:
                new[g.index] = g
                argument = None if g.argument is None else self(g.argument)
                image = target.add(g.kind, argument, g.degree)
            self.images[g.index] = image
        for index, power, relation in source.relations:
            if index in new:
                target.relate(self.images[index], power, self(relation))
        for index in new:
            inner = {name: source.variable(name) for name in source.variables}
            gradient = source.gradient(index)
            chain = [(self(outer), self(inner[name])) for name, outer in gradient.items()]
            target.set_chain(self.images[index], chain)

    def _known(self, g: Generator) -> Poly | None:
        if g.kind == "variable":
            return self.point[g.name] if g.name in self.point else self.target.variable(g.name)
        argument = None if g.argument is None else self(g.argument)
        return self.target.find(g.kind, argument, g.degree)

    def __call__(self, x: Poly) -> Poly:
        target, total = self.target, self.target.zero
        for monomial, coefficient in terms_of(x):
            term = target.context.constant(coefficient)
            for index, n in enumerate(monomial):
                if n:
                    term = term * self.images[index] ** int(n)
            total += term
        return target.reduce(total)
