"""Steps of any map with many digits, from its substeps alone: no kernel, and no closed form."""

from fractions import Fraction
from typing import Any

from verify.arithmetic.systems import mpfr
from verify.flows.extrapolation import Flow
from verify.kernels.step import newton
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.program import Evaluator, Program
from verify.schemes.step_map import StepMap, Substep

DIGITS = 60


class Stepper:
    """The steps of a map without symbols, in `digits` digits."""

    def __init__(self, step_map: StepMap, digits: int = DIGITS) -> None:
        self.arithmetic = mpfr.make(digits)
        self.field = step_map.substeps[0].field
        self._substeps = [self._compiled(step) for step in step_map.substeps]

    def _compiled(self, step: Substep) -> Any:
        program = Program()
        inputs = {name: program.input(name, static=name == "h") for name in ("p", "q", "h")}
        evaluator = Evaluator(program, step.ring, inputs, False)
        roots = [evaluator.evaluate(x) for x in (step.p_next, step.q_next)]
        lowering = Lowering(program, self.arithmetic.functions, guard=self.arithmetic.guard)
        static, dynamic = lowering.lines(roots)
        p, q = map(lowering.name, roots)
        lines = ["def at(p, q, h, steps):", *static, "for _ in range(steps):"]
        lines += [*(f"    {line}" for line in dynamic), f"    p, q = {p}, {q}", "return p, q"]
        source = "\n    ".join(lines) + "\n"
        constants = lowering.named_constants(self.arithmetic.number)
        solving = newton.constants(self.arithmetic.bits, self.arithmetic.number)
        scope = {**self.arithmetic.functions, **constants, **solving}
        return self.arithmetic.compile(source, "at", scope)

    def run(self, p: Fraction, q: Fraction, h: Fraction, steps: int) -> tuple[Any, Any]:
        with self.arithmetic.context():
            x, y, length = (self.arithmetic.number(v) for v in (p, q, h))
            if len(self._substeps) == 1:
                return self._substeps[0](x, y, length, steps)  # type: ignore[no-any-return]
            for _ in range(steps):
                for step in self._substeps:
                    x, y = step(x, y, length, 1)
            return x, y

    def error(self, p: Fraction, q: Fraction, time: Fraction, steps: int) -> float:
        """How far the map's point after `time` is from the exact flow's."""
        flow = Flow(self.field, DIGITS - 15)
        exact = flow.advance((flow.number(p), flow.number(q)), flow.number(time))
        found = self.run(p, q, time / steps, steps)
        with self.arithmetic.context():
            return float(sum(abs(x - y) for x, y in zip(found, exact, strict=True)))
