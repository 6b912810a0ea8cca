"""Functions of any coordinates take them flattened, in their order, by names where these tell."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from verify.errors import InputError
from verify.integrators.user_code.coordinate_layout import callee_of_coordinates
from verify.integrators.user_code.step import StepError

Z = [Fraction(k) for k in (1, 2, 3, 4)]


def called(function: Callable[..., Any], names: str, *, stepped: bool, **options: Any) -> Any:
    """What each layout returns for z = 1, 2, … and h = 1/2, t = 7, or the error that it raises."""
    coordinates = tuple(names.split(","))
    callee = callee_of_coordinates(function, coordinates, stepped=stepped, time_limit=10, **options)
    results = []
    for layout in callee.layouts:
        callee.step.layout = layout
        try:
            z = [float(x) for x in Z[: len(coordinates)]]
            results.append(callee.step.evaluate(z, 0.5, 7.0))
        except (StepError, TypeError, IndexError, AttributeError) as error:
            results.append(type(error).__name__)
    return results[0], str(callee.layouts[0]), results


def test_one_sequence_holds_all() -> None:
    assert called(lambda z: 2 * z, "x,y,w", stepped=False)[:2] == ((2, 4, 6), "(x, y, w)")
    assert called(lambda z, h: z + h, "x,y,w", stepped=True)[0] == (1.5, 2.5, 3.5)
    assert called(lambda z, h, t: z + t, "x,y", stepped=True)[:2] == ((8, 9), "(x, y), h, t")
    assert called(lambda t, z, h: z + t, "x,y", stepped=True)[1] == "t, (x, y), h"


def test_several_arguments_are_taken_in_their_order() -> None:
    assert called(lambda v, x: (x, v), "a1,a2,b1,b2", stepped=False)[0] == (3, 4, 1, 2)
    assert called(lambda a, b, c: (c, b, a), "x,y,w", stepped=False)[0] == (3, 2, 1)


def test_groups_of_unequal_sizes_are_told_by_the_names() -> None:
    def bath(q: Any, xi: Any) -> Any:
        return q * xi, xi + 1

    found, text, _ = called(bath, "q1,q2,q3,xi", stepped=False)
    assert (found, text) == ((4, 8, 12, 5), "(q1, q2, q3), xi")


def test_a_step_takes_its_coordinates_by_their_names() -> None:
    def step(x: Any, v: Any, dt: Any) -> Any:
        return x + dt * v, v

    assert called(step, "v,x", stepped=True)[0] == (1, 2.5)
    assert called(step, "x,v", stepped=True)[0] == (2, 2)

    def bodies(x: Any, v: Any, h: Any) -> Any:
        return x + h * v, v

    assert called(bodies, "v1,v2,x1,x2", stepped=True)[0] == (1, 2, 3.5, 5)


def test_a_coordinate_may_have_a_name_that_means_h_elsewhere() -> None:
    found, text, _ = called(lambda s, eps, h: (s + h, eps), "s,eps", stepped=True)
    assert (found, text) == ((1.5, 2), "s, eps, h")
    assert called(lambda x, y, size: (x + size, y), "x,y", stepped=True)[1] == "x, y, h"


def test_arrays_of_a_shape_and_lists_are_tried() -> None:
    def in_rows(z: Any) -> Any:
        return z[0, 0] + z[1, 1], z[0, 1], z[1, 0], z[1, 1]

    assert (5, 2, 3, 4) in called(in_rows, "a,b,c,d", stepped=False)[2]
    assert called(lambda z: z.append(0) or z[:2], "a,b", stepped=False)[2][-1] == (1, 2)


def test_further_arguments_are_given_by_name() -> None:
    options = {"parameters": {"m": Fraction(3)}}
    assert called(lambda z, m: z * m, "x,y", stepped=False, **options)[0] == (3, 6)
    with pytest.raises(InputError, match="is no argument of"):
        called(lambda z: z, "x,y", stepped=False, **options)


@pytest.mark.parametrize("names", ["x", "x,y,w", "a1,b1,a2"])
def test_arguments_that_do_not_hold_the_coordinates_are_refused(names: str) -> None:
    with pytest.raises(InputError, match=r"map=.*do not hold the"):
        called(lambda p, q: (p, q), names, stepped=False)


def test_what_is_no_state_is_told_with_the_names() -> None:
    callee = callee_of_coordinates(
        lambda x, y, w: (x, y), ("x", "y", "w"), stepped=False, time_limit=10
    )
    with pytest.raises(StepError, match="it returns 2 numbers; wanted: the new x, y, w"):
        callee.step.evaluate([1.0, 2.0, 3.0], 0.0, 0.0)
    with pytest.raises(InputError, match="is no number of seconds"):
        callee_of_coordinates(np.sin, ("x",), stepped=False, time_limit=0)
