"""Changes of functions along a run, and accumulated defects, read from its kernel's numbers."""

from collections.abc import Callable, Sequence
from fractions import Fraction

from verify.arithmetic.arb import is_representable, make_ball, midpoint_and_radius
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic
from verify.errors import InputError
from verify.kernels.run_inputs import RunInputs
from verify.kernels.statements import integrals_of
from verify.kernels.step.integral import Ball
from verify.observables.observable import Observable

_GUARD_BITS = 64


class UndefinedError(InputError):
    """A function whose change is asked for is not defined at a state of the run."""


class RunChanges:
    """I − I₀ at the end, max |I − I₀| and accumulated defects, for the observables made of them.

    I₀ is taken at the exact initial state, and I at a state as it is, without rounding. `carried`:
    the functions of which the kernel keeps the least and the greatest values. `shift`: Λ is carried
    as 2^shift Λ.
    """

    def __init__(
        self,
        run: RunInputs,
        arithmetic: Arithmetic,
        observables: Sequence[Observable],
        shift: int,
    ) -> None:
        self.run, self.bits = run, arithmetic.bits
        self._scales = {"lam": Fraction(1, 1 << shift)}
        self.carried = integrals_of(run.observables)
        self.observables = {x.name: x for x in observables if x.integral or x.structure}
        functions = (x for x in self.observables.values() if x.integral)
        self._starts = {x.integral: self._evaluate(x, run.start, 0) for x in functions}

    def parts(self, matrix: Sequence[str]) -> tuple[str, ...]:
        """Return the kernel's numbers of which accumulated defects are made, but for the state;
        `matrix`: those of M."""
        carried = {x.carried for x in self.observables.values() if x.structure}
        return (*(matrix if "m_" in carried else ()), *({"lam"} & carried))

    @property
    def start(self) -> dict[str, Fraction]:
        """The start values of the carried numbers, by name."""
        middles = (midpoint_and_radius(self._starts[integral])[0] for integral in self.carried)
        return {f"e{k}_start": x for k, x in enumerate(middles)}

    def change(
        self,
        name: str,
        done: int,
        exact: Callable[[str], Fraction],
        radius: Callable[[str], Fraction],
    ) -> tuple[Fraction, Fraction]:
        """Return the observable's value after the steps done, and how far it may be off.

        `exact`, `radius`: the midpoint and radius of a number of the kernel, by its name. Raises
        UndefinedError.
        """
        observable = self.observables[name]
        if observable.structure:
            with working_precision(self.bits + _GUARD_BITS):

                def read(number: str) -> Ball:
                    scale = self._scales.get(number, 1)
                    return make_ball(scale * exact(number), scale * radius(number))

                ball = self.run.accumulate(observable, done, read)
                if not is_representable(ball):
                    problem = f"is not defined at the state after step {done}, or at the start"
                    raise UndefinedError("keeps", observable.structure, problem)
                return midpoint_and_radius(ball)
        start, names = self._starts[observable.integral], self.run.coordinates
        radii = {n: radius(n) for n in names}
        point = {n: exact(n) for n in names}
        end = self._evaluate(observable, point, done, radii if any(radii.values()) else None)
        with working_precision(self.bits + _GUARD_BITS):
            if observable.at_end:
                return midpoint_and_radius(end - start)
            carried = f"e{self.carried.index(observable.integral)}"
            seen = [f"{carried}_{end_}" for end_ in ("low", "high")]
            extremes = [make_ball(exact(n), radius(n)) for n in seen]
            largest = abs(end - start)
            for x in extremes:
                largest = largest.max(abs(x - start))
            middle, error = midpoint_and_radius(largest)
            # The kernel begins with the middle of I₀.
            return middle, error + 2 * midpoint_and_radius(start)[1]

    def _evaluate(
        self,
        observable: Observable,
        state: dict[str, Fraction],
        done: int,
        radii: dict[str, Fraction] | None = None,
    ) -> Ball:
        run = self.run
        integral = run.integral(observable.integral)
        point = {**run.parameters, **run.in_user_names({n: state[n] for n in run.coordinates})}
        point["t"] = run.start.get("t", Fraction(0)) + done * run.start["h"]
        value: Ball | None
        if radii is None:
            value = integral.evaluate(point, self.bits)
        else:
            with working_precision(self.bits + _GUARD_BITS):
                errors = run.in_user_names(radii)
                value = integral.enclose(
                    {n: make_ball(x, errors.get(n, Fraction(0))) for n, x in point.items()}
                )
        if value is None:
            place = f"the state after step {done}" if done else "the start"
            raise UndefinedError("integral", observable.integral, f"is not defined at {place}")
        return value
