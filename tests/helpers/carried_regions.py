"""Regions carried by a scheme or by the exact flow, and what is read of their images."""

from fractions import Fraction
from typing import Any

from verify.execution.keeper import NOTHING
from verify.scenes.region_sections import PlacedShape
from verify.scenes.results.regions import FlowImage
from verify.studies.kinds.regions import FlowTask

DUFFING, OSCILLATOR = "p**2/2 + q**2/2 + q**4/4", "p**2/2 + q**2/2"


def carried(scheme: str = "lie2", h: Any = "0.1", steps: int = 10, **more: Any) -> FlowImage:
    """A disc of the plane, by Duffing's oscillator, but for what is said in `more`."""
    shape = more.pop("shape", {"shape": "circle", "centre": {"q": 1, "p": 0}, "scale": "0.5"})
    fields = {
        "hamiltonian": DUFFING, "parameters": {}, "map": scheme, "shape": PlacedShape(**shape),
        "step_size": Fraction(h), "steps": steps, "digits": 17, "mean_lambda": True,
        "distance": False,
    }  # fmt: skip
    return FlowTask(**{**fields, **more}).compute(NOTHING)


def change_of_area(image: FlowImage) -> tuple[Fraction, Fraction]:
    """The relative change of its area, and the probe's error."""
    return Fraction(image.area_change or "nan"), Fraction(image.probe_error or "nan")


def mean_of_defect(image: FlowImage) -> tuple[Fraction, Fraction]:
    """The mean of Λ, or in n degrees of freedom that of W in the region's plane, and its error."""
    mean = image.mean_lambda or image.mean_defect
    error = image.mean_lambda_error or image.mean_defect_error
    return Fraction(mean or "nan"), Fraction(error or "nan")


def within(image: FlowImage, true: Fraction) -> bool:
    change, error = change_of_area(image)
    return abs(change - true) <= error
