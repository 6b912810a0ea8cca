"""asinh x = log(x + √(1 + x²)), odd, with slope 1 at 0."""

from typing import Any

from verify.functions.function import FixedPoint, Function


def _asinh(numbers: Any, x: Any) -> Any:
    """Return log(|x| + √(1 + x²)), or log |x| + log(1 + √(1 + 1/x²)) from |x| = 1 on, with x's
    sign.

    So all intermediate values stay in the range, and all logarithms are of numbers from 1 on. With
    u a unit of the finer numbers the root's argument, 1 at least, is off by 3 u, the root by 2060
    u, and the sum of logarithms, whose slopes are at most 1, by 2062 u. That is 2^−52 units of the
    result's numbers, to which it is rounded.
    """
    size, one, choose = numbers.absolute(x), numbers.one, numbers.choose
    large = numbers.at_least(size, one)
    above = choose(large, size, one)
    small = choose(large, numbers.apply("inverse", above), size)
    root = numbers.apply("sqrt", one + small * small)
    least = numbers.apply("log", choose(large, one, small) + root)
    return numbers.signed(choose(large, least + numbers.apply("log", above), least), x)


FUNCTION = Function(
    "asinh",
    slope=lambda x, apply: apply("sqrt", 1 + x * x) * apply("inverse", 1 + x * x),
    lipschitz=1,
    image=lambda t, x: t.logarithm(x + t.root(x * x + t.field.one, 2)),
    positive=lambda x: x,
    # Between its ends' values, as it increases: arb's own is NaN where a ball is wide.
    ball=lambda x: x.lower().asinh().union(x.upper().asinh()),
    fixed=FixedPoint("0.501", composed=_asinh),
    numpy="arcsinh",
    shown="arsinh",
    tex=r"\operatorname{arsinh}",
    synonyms=("arsinh", "arsh"),
)
