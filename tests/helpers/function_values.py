"""What a number system's function gives, against mpmath's value at many digits."""

from fractions import Fraction

from mpmath.ctx_mp import MPContext

from verify.arithmetic.number_system import Arithmetic


def off(numbers: Arithmetic, name: str, x: Fraction) -> Fraction:
    """How far the arithmetic's value is from mpmath's, at the number next to x."""
    called = numbers.compile(f"def f(x): return {name}(x)\n", "f", numbers.functions)
    with numbers.context():
        at = numbers.number(x)
        value = numbers.exact(called(at))
    return abs(value - true(name, numbers.exact(at)))


def true(name: str, x: Fraction, digits: int = 400) -> Fraction:
    """The value by mpmath at so many digits."""
    context = MPContext()
    context.dps = digits
    exact = getattr(context, name)(context.mpf(x.numerator) / x.denominator)
    sign, mantissa, exponent, _ = exact._mpf_
    return (-1) ** sign * int(mantissa) * Fraction(2) ** exponent
