"""The competitor: lie2 with the closed form of ΔJ, Λ, MSE and max |ΔJ|, in mpmath written tightly.

Twice each: with mpf's operators, as a user would write it, and one level down with libmp's
functions on raw numbers, which is faster. The operations and their order are those of
duffing_lie2_mpfr.c and pendulum_lie2_mpfr.c, so that on the Duffing system all three must give
the same numbers, bit for bit.

Each function returns the seconds of its loop and the results as exact rationals.
"""

import time
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from mpmath import libmp
from mpmath.ctx_mp import MPContext

Result = tuple[float, dict[str, Fraction]]
STEP_SIZE, DELTA, Q, P = "0.001", "1", "1.5", "0"
NAMES = ("lambda", "mse", "delta_j_max", "q", "p")


def duffing(steps: int, digits: int, *, bits: int | None = None, operators: bool = False) -> Result:
    """`bits` overrides what mpmath takes for `digits` decimal digits."""
    loop = _duffing_operators if operators else _duffing_libmp
    return _timed(loop, steps, bits or libmp.dps_to_prec(digits))


def pendulum(
    steps: int, digits: int, *, bits: int | None = None, operators: bool = False
) -> Result:
    loop = _pendulum_operators if operators else _pendulum_libmp
    return _timed(loop, steps, bits or libmp.dps_to_prec(digits))


def _timed(loop: Callable[[int, int], tuple[float, list[Any]]], steps: int, bits: int) -> Result:
    seconds, (lam, mse, top, q, p) = loop(steps, bits)
    mse = libmp.mpf_div(mse, libmp.from_int(steps), bits, "n")
    found = zip(NAMES, (lam, mse, top, q, p), strict=True)
    return seconds, {name: Fraction(*map(int, libmp.to_rational(x))) for name, x in found}


def _numbers(bits: int, *texts: str) -> list[Any]:
    return [libmp.from_str(text, bits, "n") for text in texts]


def _duffing_libmp(steps: int, bits: int) -> tuple[float, list[Any]]:
    mul, add, sub, size_of = libmp.mpf_mul, libmp.mpf_add, libmp.mpf_sub, libmp.mpf_abs
    greater, shift = libmp.mpf_gt, libmp.mpf_shift
    r = "n"
    h, delta, q, p = _numbers(bits, STEP_SIZE, DELTA, Q, P)
    h_half = shift(h, -1)
    w_q2 = mul(h_half, delta, bits, r)
    h2_half = mul(h, h_half, bits, r)
    g_q2 = mul(mul(h2_half, delta, bits, r), libmp.from_int(3), bits, r)
    pq_factor = shift(mul(g_q2, h, bits, r), 1)
    lam = mse = top = libmp.fzero
    begun = time.perf_counter()
    for _ in range(steps):
        q2 = mul(q, q, bits, r)
        g = add(mul(g_q2, q2, bits, r), h2_half, bits, r)
        w = mul(add(mul(w_q2, q2, bits, r), h_half, bits, r), q, bits, r)
        dj = add(mul(g, g, bits, r), mul(mul(p, q, bits, r), pq_factor, bits, r), bits, r)
        lam = add(lam, add(mul(lam, dj, bits, r), dj, bits, r), bits, r)
        mse = add(mse, mul(dj, dj, bits, r), bits, r)
        size = size_of(dj)
        if greater(size, top):
            top = size
        s = sub(p, w, bits, r)
        p = sub(sub(s, w, bits, r), mul(p, g, bits, r), bits, r)
        q = add(q, mul(s, h, bits, r), bits, r)
    return time.perf_counter() - begun, [lam, mse, top, q, p]


def _duffing_operators(steps: int, bits: int) -> tuple[float, list[Any]]:
    context = MPContext()
    context.prec = bits
    h, delta, q, p = map(context.make_mpf, _numbers(bits, STEP_SIZE, DELTA, Q, P))
    h_half = h / 2
    w_q2 = h_half * delta
    h2_half = h * h_half
    g_q2 = h2_half * delta * 3
    pq_factor = g_q2 * h * 2
    lam = mse = top = context.mpf(0)
    begun = time.perf_counter()
    for _ in range(steps):
        q2 = q * q
        g = g_q2 * q2 + h2_half
        w = (w_q2 * q2 + h_half) * q
        dj = g * g + p * q * pq_factor
        lam += lam * dj + dj
        mse += dj * dj
        size = abs(dj)
        if size > top:
            top = size
        s = p - w
        p = s - w - p * g
        q += s * h
    return time.perf_counter() - begun, [x._mpf_ for x in (lam, mse, top, q, p)]


def _pendulum_libmp(steps: int, bits: int) -> tuple[float, list[Any]]:
    mul, add, sub, size_of = libmp.mpf_mul, libmp.mpf_add, libmp.mpf_sub, libmp.mpf_abs
    greater, shift, cos_sin = libmp.mpf_gt, libmp.mpf_shift, libmp.mpf_cos_sin
    r = "n"
    h, q, p = _numbers(bits, STEP_SIZE, Q, P)
    h_half = shift(h, -1)
    h2 = mul(h, h, bits, r)
    h2_half = shift(h2, -1)
    lam = mse = top = libmp.fzero
    begun = time.perf_counter()
    for _ in range(steps):
        c, s = cos_sin(q, bits, r)
        w = mul(s, h_half, bits, r)
        g = mul(c, h2_half, bits, r)
        dj = sub(mul(g, g, bits, r), mul(mul(p, w, bits, r), h2, bits, r), bits, r)
        lam = add(lam, add(mul(lam, dj, bits, r), dj, bits, r), bits, r)
        mse = add(mse, mul(dj, dj, bits, r), bits, r)
        size = size_of(dj)
        if greater(size, top):
            top = size
        s = sub(p, w, bits, r)
        p = sub(sub(s, w, bits, r), mul(p, g, bits, r), bits, r)
        q = add(q, mul(s, h, bits, r), bits, r)
    return time.perf_counter() - begun, [lam, mse, top, q, p]


def _pendulum_operators(steps: int, bits: int) -> tuple[float, list[Any]]:
    context = MPContext()
    context.prec = bits
    cos_sin = context.cos_sin
    h, q, p = map(context.make_mpf, _numbers(bits, STEP_SIZE, Q, P))
    h_half = h / 2
    h2 = h * h
    h2_half = h2 / 2
    lam = mse = top = context.mpf(0)
    begun = time.perf_counter()
    for _ in range(steps):
        c, s = cos_sin(q)
        w = s * h_half
        g = c * h2_half
        dj = g * g - p * w * h2
        lam += lam * dj + dj
        mse += dj * dj
        size = abs(dj)
        if size > top:
            top = size
        s = p - w
        p = s - w - p * g
        q += s * h
    return time.perf_counter() - begun, [x._mpf_ for x in (lam, mse, top, q, p)]
