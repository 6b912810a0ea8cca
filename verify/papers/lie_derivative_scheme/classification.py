"""All Hamiltonians for which lie2 preserves area exactly: their classification, step by step."""

from verify.papers.argument import Argument, ArgumentTexts, Step
from verify.papers.lie_derivative_scheme import developables, families
from verify.papers.lie_derivative_scheme.determinant import PRESERVED, area_is_preserved

_TEXTS = ArgumentTexts(__file__)


def determinant_classification(flaw: int = 0) -> Argument:
    """Classify all H for which lie2 preserves area exactly; `flaw` spoils the conic family."""
    return _TEXTS.proof(
        "determinant_classification",
        coefficients=families.coefficients(),
        acceleration=families.acceleration(),
        by_acceleration=families.by_acceleration(),
        without_curvature=_without_curvature(),
        with_curvature=_with_curvature(),
        conic=_conic(flaw),
        polynomial=_polynomial(),
        separable=_separable(),
    )


def _without_curvature() -> list[Step]:
    """Treat the case D = 0 on an open set."""
    return _TEXTS.steps(
        "_without_curvature",
        developable=developables.developable(),
        radial=developables.radial(),
        linear=families.linear(),
    )


def _with_curvature() -> list[Step]:
    """Treat D ≠ 0 by the Legendre transform, with one identity for the rest."""
    return _TEXTS.steps(
        "_with_curvature",
        equilibrium=families.equilibrium(),
        legendre=developables.legendre(),
        ruled_hessian=developables.ruled_hessian(),
        adjugate_identity=developables.adjugate_identity(),
        contraction=developables.contraction(),
    )


def _conic(flaw: int) -> list[Step]:
    """Show that the two families with D ≠ 0 exist and preserve area."""
    conic = developables.Conic(flaw)
    return _TEXTS.steps(
        "_conic",
        parabolic=families.parabolic(),
        exact_flow=families.exact_flow(),
        ruling=developables.ruling(),
        comparison=developables.comparison(),
        exists=conic.exists(),
        preserves_area=conic.preserves_area(),
        area_is_preserved=map(area_is_preserved, PRESERVED),
    )


def _polynomial() -> list[Step]:
    return _TEXTS.steps("_polynomial")


def _separable() -> list[Step]:
    return _TEXTS.steps("_separable", separable=families.separable(), twice=families.twice())
