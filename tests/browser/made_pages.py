"""Small pages made by the real code: a paper's claims, a user's scene, a hunt's gallery; all with
hostile text."""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

from tests.helpers.constructed.galleries import CROSSED, KEPT, NOTHING, gallery, shown
from verify.claims.base_claim import Claim
from verify.claims.kinds.delta_j import DeltaJClaim
from verify.claims.kinds.monotone import MonotoneClaim
from verify.claims.kinds.table import PrintedTableClaim
from verify.claims.kinds.theorem import TheoremClaim
from verify.claims.verdicts import gallery_report, make_report
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.pages.page import render
from verify.scenes.paper_sections import PaperFigure
from verify.scenes.results.report import Report
from verify.scenes.scene import scene_from

EVIL = "<script>window.planted = 1</script><img src=x onerror='window.planted = 2'>"
FLOW = "Figure 4 <script>window.planted = 3</script>"  # a label may be 80 characters long

_ARGUED = ("eq-3", "eq-11", "convergence", "determinant-classification")  # with long formulas
_GRID: dict[str, Any] = {
    "time": "0.2", "step_sizes": ["0.01", "0.02", "0.03"], "separate": True,
    "initial_values": [{"q": "1", "p": "0"}, {"q": "0", "p": "-1.5"}],
    "observables": ["delta_j_max", "mse", "lambda", "lambda_plain"],
}  # fmt: skip


def paper() -> Report:
    """Claims by section, among them a refuted table and an argument on paper; runs, separated."""
    scene = scene_from(
        {
            "name": "duffing", "title": f"Duffing {EVIL}", "system": "duffing",
            "parameters": {"delta": 1}, "schemes": ["lie2", "symplectic-euler"],
            "criteria": [1, 2, 3, 4], "grid": _GRID,
            "series": [{"step_size": "0.01", "time": "1", "initial_value": {"q": "1", "p": "0"}}],
            "flow": [
                {"shape": "circle", "centre": {"q": 1, "p": 0}, "scale": "0.5",
                 "step_size": "0.05", "steps": [10, 20], "source": FLOW},
                {"polygon": [["0", "0"], ["1", "0"], ["0", "1"]], "step_size": "0.05",
                 "steps": [5], "schemes": ["lie2"]},
            ],
        },
        "duffing",
    )  # fmt: skip
    common = {"section": "4.1 The Duffing system", "scene": "duffing", "scheme": "lie2"}
    claims: list[Claim] = [
        PrintedTableClaim.model_validate(
            common | {"id": "table-9", "source": "Table 9", "statement": f"A table. {EVIL}",
                      "kind": "table", "step_sizes": ["0.01", "0.02"],
                      "printed": ["-1.3010", "-1.0000"]}
        ),
        DeltaJClaim.model_validate(
            common | {"id": "eq-21", "source": "Eq. 21", "statement": "ΔJ = 3h³δpq + O(h⁴).",
                      "kind": "delta_j", "formula": "3*h**3*delta*p*q", "up_to": 4}
        ),
        MonotoneClaim.model_validate(
            common | {"id": "grows", "source": "Figure 9", "kind": "monotone", "quantity": "mse",
                      "direction": "increases", "statement": "MSE increases."}
        ),
        *(TheoremClaim(id=name, source=f"{name}.", section="2.1 Discretization", kind="theorem",
                       statement="L_{H_p}(p_k) = H_p.", name=name) for name in _ARGUED),
    ]  # fmt: skip
    figures = [
        PaperFigure(label="Figure 1", caption=f"Errors {EVIL}", scene="duffing", shows="runs",
                    claims=("grows",), assumed=f"T. {EVIL}"),
        PaperFigure(label=FLOW, caption="Flow.", scene="duffing", shows="flow"),
    ]  # fmt: skip
    return _report(f"A paper {EVIL}", scene, claims, figures)


def own_scene() -> Report:
    """No claims: proofs, runs and stability; the formula is one that no parser would let pass."""
    scene = scene_from(
        {
            "name": "mine", "title": "A quartic oscillator", "hamiltonian": "p**2/2 + a*q**4",
            "parameters": {"a": "1/3"}, "schemes": ["lie2", "symplectic-euler"],
            "criteria": [1, 2, 3, 4], "grid": _GRID,
            "stability": [{"steps": 100, "step_sizes": ["0.01", "2"],
                           "initial_values": [{"q": "1", "p": "0"}]}],
        },
        "mine.toml",
    )  # fmt: skip
    made = _report("My oscillator", scene, [])
    (found,) = made.scenes
    return made.model_copy(update={"scenes": (found.model_copy(update={"hamiltonian": EVIL}),)})


def hunted() -> Report:
    """A gallery and nothing else; one formula is no formula."""
    formulas = [f"p**{n}/2 + q**2/(1 + p**2) - cos({n}*q)" for n in range(2, 7)]
    scenes = [shown(KEPT, hamiltonian=formula, value=4.0 - n) for n, formula in enumerate(formulas)]
    others = [shown(CROSSED, meaningless_after=100), shown(NOTHING), shown(None, hamiltonian=EVIL)]
    found = gallery(*scenes, *others, sentence=f"greatest part {EVIL}")
    return gallery_report(found, "verify explore", 0.0, 0, 1, THIS_PROCESS)


def _report(
    title: str, scene: Any, claims: list[Claim], figures: Sequence[PaperFigure] = ()
) -> Report:
    command = "verify report"
    return make_report(
        title, [scene], claims, Store(None), command=command, figures=figures, where=THIS_PROCESS
    )


_MADE: dict[str, Callable[[], Report]] = {"paper": paper, "own scene": own_scene, "hunt": hunted}
NAMES = tuple(_MADE)


@cache
def page_of(name: str, *, full: bool = False) -> str:
    return render(_MADE[name](), full=full)


def planted(name: str, text: str, *, policy: bool = True) -> str:
    """The page with a piece of HTML at the end of its content, and without its policy on demand."""
    page = page_of(name).replace("</main>", f"{text}</main>")
    return page if policy else page.replace("Content-Security-Policy", "x-none")
