"""Λ composes: 1 + Λ over N steps is the product of 1 + Λ over the first M and over the others."""

from fractions import Fraction

from verify import arithmetic as number_systems
from verify.arithmetic.exact import decimal
from verify.exploration.property import Violation
from verify.exploration.sample import Sample
from verify.kernels.stepping import KernelRun

_DIGITS = 50
_KNOWN = Fraction(1, 10**30)


def holds(sample: Sample) -> bool:
    if sample.steps < 2 or not sample.short or sample.step_map.preserves_area:
        return False
    middle = sample.steps // 2
    whole = _run(sample, sample.start, sample.steps)
    first = _run(sample, sample.start, middle)
    if whole is None or first is None:
        return False
    after = {"p": first["p"], "q": first["q"], "h": sample.step_size}
    second = _run(sample, after, sample.steps - middle)
    if second is None:
        return False
    product = (1 + first["lambda"]) * (1 + second["lambda"])
    size = 1 + abs(first["lambda"]) + abs(second["lambda"])
    if abs(1 + whole["lambda"] - product) > _KNOWN * size**2:
        found, wanted = decimal(whole["lambda"], 12), decimal(product - 1, 12)
        raise Violation(f"Λ over {sample.steps} steps is {found}, and composed {wanted}")
    return True


def _run(sample: Sample, start: dict[str, Fraction], steps: int) -> dict[str, Fraction] | None:
    """p, q and Λ after the steps; None where they leave the range in which digits are kept."""
    wanted = frozenset({"lambda"})
    run = KernelRun(sample.hamiltonian, sample.scheme.name, start, steps, wanted, 0)
    found = run.run(number_systems.get("mpfr", _DIGITS))
    if found.done < steps or max(abs(x) for x in found.values.values()) > 10**6:
        return None
    return found.values
