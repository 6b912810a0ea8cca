"""Regions carried by maps, made by hand for tests of what a page makes of them."""

from math import cos, pi, sin
from typing import Any

from verify.scenes.results.regions import (
    EXACT_FLOW,
    CarriedOutline,
    DrawnOutline,
    FlowImage,
    FlowResult,
    Projection,
)


def circle(q: float = 0, p: float = 0, radius: float = 1, count: int = 40) -> str:
    turns = [2 * pi * i / count for i in range(count)]
    return " ".join(f"{q + radius * cos(x):.5g},{p + radius * sin(x):.5g}" for x in turns)


def spiral(turns: int = 5) -> str:
    out = [(0.5 + i / 100, 2 * pi * turns * i / 100) for i in range(100)]
    there = [(r * cos(x), r * sin(x)) for r, x in out]
    back = [(0.98 * r * cos(x), 0.98 * r * sin(x)) for r, x in reversed(out)]
    return " ".join(f"{q:.5g},{p:.5g}" for q, p in there + back)


def outline(points: str, name: str = "circle", **changes: Any) -> CarriedOutline:
    own = {"area": "3.14", "area_change": "0", "probe_error": "1e-12", "nodes": 64}
    return CarriedOutline(name=name, points=points, **(own | changes))


def image(**changes: Any) -> FlowImage:
    """By lie2, changing area; its outline moved by its number of steps, so that images differ."""
    steps = changes.get("steps", 100)
    own: dict[str, Any] = {
        "map": "lie2", "steps": steps, "time": str(steps / 100), "area_preserving": False,
        "area_change": "-1.2345e-05", "probe_error": "3.1e-11", "mean_lambda": "-1.234e-05",
        "mean_lambda_error": "2.0e-08", "agree": True, "distance": "4.321e-04",
        "distance_error": "5.6e-06", "arithmetic": "float64", "digits": 17, "seconds": 0.1,
        "outlines": (outline(circle(steps / 100)), outline(circle(steps / 100, radius=0.3), "eye")),
    }  # fmt: skip
    return FlowImage.model_validate(own | changes)


def exact(**changes: Any) -> FlowImage:
    own: dict[str, Any] = {
        "map": EXACT_FLOW, "area_preserving": True, "area_change": "3e-13",
        "probe_error": "7.7e-12", "mean_lambda": None, "mean_lambda_error": None,
        "agree": None, "distance": None, "distance_error": None,
    }  # fmt: skip
    return image(**(own | changes))


def flow(*images: FlowImage, **changes: Any) -> FlowResult:
    own: dict[str, Any] = {
        "shape": "circle", "centre": ("0", "0"), "scale": "1", "step_size": "0.01",
        "before": (DrawnOutline(name="circle", points=circle()),), "images": images,
    }  # fmt: skip
    return FlowResult.model_validate(own | changes)


EULER = {
    "map": "symplectic-euler", "area_preserving": True, "area_change": "2e-13",
    "probe_error": "8.8e-12", "mean_lambda": None, "mean_lambda_error": None, "agree": None,
    "distance": "6.54e-02",
}  # fmt: skip
TWO = flow(
    exact(steps=100), exact(steps=300), image(steps=100),
    image(steps=300, area_change="9.8765e-04", distance="7.77e-03"),
)  # fmt: skip
LONG = {"outlines": (outline(spiral()),)}
THREE = flow(
    *(
        made(steps=n, **kind, **LONG)
        for made, kind in ((exact, {}), (image, {}), (image, EULER))
        for n in (5000, 10000)
    )
)
FAILED = image(
    steps=400, outlines=(), area_change=None, probe_error=None, mean_lambda=None,
    mean_lambda_error=None, agree=None, distance=None, distance_error=None,
    problem="left the range of float64 at step 7",
)  # fmt: skip


def in_degrees(**changes: Any) -> FlowResult:
    """A circle in two degrees of freedom, by the exact flow and lie2; seen in either plane."""
    projections = tuple(
        Projection(plane=k, area=area, area_error="1e-12", points=circle(1 + k))
        for k, area in ((1, "0.75"), (2, "0.25"))
    )
    seen = (outline(circle(2), projections=projections),)
    by_lie2 = {
        "mean_lambda": None, "mean_lambda_error": None, "distance": None, "distance_error": None,
        "mean_defect": "-1.234e-05", "mean_defect_error": "2.0e-08", **changes,
    }  # fmt: skip
    images = (exact(outlines=seen), image(outlines=seen, **by_lie2))
    point = {"p1": "0", "p2": "0.5", "q1": "0", "q2": "0.1"}
    return flow(*images, plane=1, point=point)
