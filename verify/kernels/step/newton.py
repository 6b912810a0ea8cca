"""Newton's method for unknowns that are defined by equations, as the source of a loop in the loop.

It goes on until an update is no more than the last places of the p or q that it is added to, or
would be followed by such a one. Each of Newton's updates is a multiple of the square of the one
before; the last two give the multiple, so that after one of `size` the next would have the size
size·(size/last)². That is believed once half of the digits are settled. An update that is no
smaller than the one before is only rounding, if half of the digits are settled, and ends it as
well.

The solution sought is the one that goes over into 0 with h. On the way there ∂F/∂Z, which is the
unit matrix at h = 0, does not become singular; so a solution where its determinant is not positive
is another one. Where that is found, where an update grows out of all proportion, an unknown leaves
the arithmetic's range, or 25 updates do not settle, the method starts once more, at 0. Where that
fails too the unknowns are set to 0/0, which ends the run at that step. (Where h is so large that
there are several solutions with a positive determinant, it may be any of them.)
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.arithmetic.number import Number

MOST_UPDATES = 25  # where h is small 2 … 4 are needed for 17 digits, 5 … 8 for 200
_ATTEMPTS = 2


def constants(bits: int, number: Callable[[Fraction], Number]) -> dict[str, Number]:
    """Return the numbers that the loops compare with, by their names in the source, for numbers of
    so many bits."""
    return {
        "newton_zero": number(Fraction(0)),
        "newton_last": number(Fraction(1, 2 ** (bits + 1))),
        "newton_half": number(Fraction(1, 2 ** (bits // 2))),
        "newton_most": number(Fraction(2**16)),
    }


@dataclass(frozen=True)
class Source:
    """The loop for unknowns `prefix`0, `prefix`1, …; all other fields are names of values.

    `turn`: the lines that compute the `updates`, to be subtracted, and the `determinants`, whose
    product is that of ∂F/∂Z. `guard` as in `verify.arithmetic.number_system.Arithmetic`.
    """

    prefix: str
    starts: Sequence[str]
    updates: Sequence[str]
    added_to: Sequence[str]
    determinants: Sequence[str]
    turn: Sequence[str]
    guard: str | None

    @property
    def unknowns(self) -> list[str]:
        return [f"{self.prefix}{k}" for k in range(len(self.updates))]

    def lines(self) -> list[str]:
        """Return the statements of both attempts."""
        converged = f"{self.prefix}found"
        pairs = zip(self.unknowns, self.starts, strict=True)
        positive = " * ".join(self.determinants)
        attempt = [
            f"{converged} = 0",
            f"for turn in range({MOST_UPDATES}):",
            *(f"    {line}" for line in self._iteration_lines(f"{converged} = 1")),
            f"if {converged} == 1 and {positive} > newton_zero: break",
            f"if attempt == {_ATTEMPTS - 1}:",
            *(f"    {u} = ({u} - {u}) / ({u} - {u})" for u in self.unknowns),
            "    break",
            *(f"{u} = newton_zero" for u in self.unknowns),
        ]
        # The first values of these are never read: they give them a type.
        names = [self.prefix + n for n in ("size", "last", "first", "ratio")]
        names += [x for x in self.determinants if any(s.startswith(f"{x} =") for s in self.turn)]
        return [
            *(f"{u} = {x}" for u, x in pairs),
            f"{' = '.join(names)} = newton_zero",
            f"for attempt in range({_ATTEMPTS}):",
            *(f"    {line}" for line in attempt),
        ]

    def _iteration_lines(self, stop: str) -> list[str]:
        """Return the statements of one iteration; `stop` is run where it has converged."""
        size, last, first, ratio = (self.prefix + n for n in ("size", "last", "first", "ratio"))
        pairs = zip(self.unknowns, self.updates, strict=True)
        sizes, widths, small = self._by_component()
        whole = " + ".join(width for width, _ in widths)
        end = [f"    {stop}", "    break"]
        return [
            *self._guard_lines(),
            *self.turn,
            *(f"{u} = {u} - {d}" for u, d in pairs),
            *(f"{name} = {sum_}" for name, sum_ in (*sizes, *widths)),
            f"{size} = {' + '.join(name for name, _ in sizes)}",
            f"if {small('')}:",
            *end,
            # The first update sets the scale; one that is 2^16 times as large has diverged.
            f"if turn == 0: {first} = {size} + {whole}",
            f"if turn > 0 and {size} <= newton_half * ({whole}):",
            f"    {ratio} = {size} / {last}",
            f"    if {size} >= {last} or {small(f' * {ratio} * {ratio}')}:",
            *(f"    {line}" for line in end),
            f"if not {size} <= newton_most * {first}: break",
            f"{last} = {size}",
        ]

    def _by_component(
        self,
    ) -> tuple[list[tuple[str, str]], list[tuple[str, str]], Callable[[str], str]]:
        """Return, for p and for q, names and sums of the sizes of the updates and of the values
        they are added to; and the condition that all sizes, times a factor, are small."""
        sizes, widths = [], []
        for part, base in enumerate(dict.fromkeys(self.added_to)):
            members = [k for k, name in enumerate(self.added_to) if name == base]
            total = " + ".join(f"abs({self.updates[k]})" for k in members)
            sizes.append((f"{self.prefix}by{part}", total))
            total = " + ".join(f"abs({x})" for x in (base, *(self.unknowns[k] for k in members)))
            widths.append((f"{self.prefix}of{part}", total))

        def small(factor: str) -> str:
            both = zip(sizes, widths, strict=True)
            return " and ".join(f"{x}{factor} <= newton_last * {w}" for (x, _), (w, _) in both)

        return sizes, widths, small

    def _guard_lines(self) -> list[str]:
        if self.guard is None:
            return []
        inside = " and ".join(self.guard.format(x=u) for u in self.unknowns)
        return [f"if not ({inside}): break"]
