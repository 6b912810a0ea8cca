"""What is drawn of the points at which orbits pass a surface."""

import numpy as np

from verify.pages.figures.orbit_points_figure import select_points
from verify.scenes.results.orbit_points import MapSections, PoincareOrbit, PoincareResult


def orbit(*points: tuple[str, str], left: bool = False) -> PoincareOrbit:
    return PoincareOrbit(
        q=("0", "0"), p=("1", "0"), energy="0.5", points=points, known=len(points), error="1e-12",
        left=left,
    )  # fmt: skip


def test_points_of_an_orbit_that_escapes_do_not_blow_up_the_picture() -> None:
    near = tuple((f"{np.cos(k):.4f}", f"{np.sin(k):.4f}") for k in range(100))
    far = orbit(*near[:10], ("1e+120", "-1e+150"), left=True)
    sections = MapSections(map="lie2", orbits=(orbit(*near), far), arithmetic="mpfr", digits=33,
                           seconds=0.1)  # fmt: skip
    result = PoincareResult(
        coordinate="q1", value="0", rising=True, draw=("q2", "p2"), step_size="0.1", steps=9,
        time="0.9", sections=(sections,),
    )  # fmt: skip
    points, outside = select_points(result)
    assert outside == 1
    assert np.nanmax(np.abs(np.concatenate(points[0]))) <= 1
    assert not np.isnan(points[0][0]).any()
