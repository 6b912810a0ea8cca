"""The page: well-formed, escaped, self-contained, the same each time, and without empty parts."""

import base64
import hashlib
import re
from collections.abc import Callable
from functools import cache
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.pages.imported_modules import imported_by
from verify.claims.base_claim import Claim
from verify.claims.kinds.monotone import MonotoneClaim
from verify.claims.kinds.table import PrintedTableClaim
from verify.claims.verdicts import make_report
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.pages.page import TEMPLATES, render, write
from verify.pages.text.typography import number
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.report import Provenance, Report, SceneResult, read_report
from verify.scenes.results.run import RunResult
from verify.scenes.scene import scene_from
from verify.verdict import Verdict

EVIL = '<script>alert("x")</script>'
SCRIPT = (TEMPLATES / "page.js").read_text(encoding="utf-8")
VOID = {"meta", "br", "link", "img", "hr", "input"}

# -- small reports --------------------------------------------------------------------------------


def proof(**changes: Any) -> ProofResult:
    own: dict[str, Any] = {
        "hamiltonian": "p**2/2 + a*q**4/4", "parameters": {}, "scheme": "lie2",
        "verdict": Verdict.PROVED, "reason": "shown", "order": 3, "leading": "3*a*p*q",
        "delta_j": "3*a*h**3*p*q", "area_preserving": False, "convergence_order": 2,
        "witness": {"p": "1/2"}, "enclosure": "[0.5 +/- 1e-10]", "p_next": "p - h*a*q**3",
        "q_next": "q + h*p", "jacobian": (("1", "-3*a*h*q**2"), ("h", "1")), "seconds": 0.1,
    }  # fmt: skip
    return ProofResult.model_validate(own | changes)


def run(**changes: Any) -> RunResult:
    own: dict[str, Any] = {
        "hamiltonian": "p**2/2", "parameters": {}, "scheme": "lie2", "arithmetic": "float64",
        "digits": 17, "step_size": "0.01", "steps": 100, "q": "1", "p": "-0.5",
        "status": "finished", "failed_step": None, "error_kind": "estimated",
        "values": {"lambda": Value(value="-1.23e-05", bound="4.00e-08")},
        "error_method": "a rerun", "exact": (), "series": (), "seconds": 0.1,
    }  # fmt: skip
    return RunResult.model_validate(own | changes)


def scene(**changes: Any) -> SceneResult:
    own: dict[str, Any] = {
        "name": "mine", "title": "My oscillator", "hamiltonian": "p**2/2 + a*q**4/4",
        "parameters": {}, "source": "mine", "time": None, "proofs": (proof(),), "criteria": (),
        "runs": (), "series": (),
    }  # fmt: skip
    return SceneResult.model_validate(own | changes)


def claim(**changes: Any) -> ClaimResult:
    own: dict[str, Any] = {
        "id": "eq-1", "source": "Eq. 1", "statement": "It is so.", "scene": "mine",
        "verdict": Verdict.PROVED, "evidence": "it is",
    }  # fmt: skip
    return ClaimResult.model_validate(own | changes)


def report(scenes: tuple[SceneResult, ...] = (), **changes: Any) -> Report:
    made = Provenance(
        command="verify report mine.toml", versions={"Python": "3"}, machine="one", seconds=1.0,
        kept=0, computed=1,
    )  # fmt: skip
    own: dict[str, Any] = {
        "title": "Mine",
        "claims": (),
        "scenes": scenes,
        "left_out": (),
        "provenance": made,
    }
    return Report.model_validate(own | changes)


@cache
def real() -> Report:
    """A tiny scene through the real pipeline: grid, series, a wrong table and a true claim."""
    common = {"source": "Table 9", "statement": "A table.", "scene": "duffing", "scheme": "lie2"}
    tiny = scene_from(
        {
            "name": "duffing", "title": "Duffing", "system": "duffing", "parameters": {"delta": 1},
            "schemes": ["lie2", "symplectic-euler"], "criteria": [1, 2, 3, 4],
            "grid": {
                "time": "0.2", "step_sizes": ["0.01", "0.02", "0.03"],
                "initial_values": [{"q": "1", "p": "0"}, {"q": "0", "p": "-1.5"}],
                "observables": ["delta_j_max", "mse", "lambda", "lambda_plain"],
            },
            "series": [{"step_size": "0.01", "time": "1", "initial_value": {"q": "1", "p": "0"},
                        "source": "Figure 3"}],
        },
        "duffing",
    )  # fmt: skip
    claims: list[Claim] = [
        PrintedTableClaim.model_validate(
            common | {"id": "table-9", "kind": "table", "step_sizes": ["0.01", "0.02"],
                      "printed": ["-1.3010", "-1.0000"]}
        ),
        MonotoneClaim.model_validate(
            common | {"id": "grows", "source": "Figure 9", "kind": "monotone", "quantity": "mse",
                      "direction": "increases"}
        ),
    ]  # fmt: skip
    return make_report(
        "Tiny", [tiny], claims, Store(None), command="verify report", where=THIS_PROCESS
    )


# -- reading a page -------------------------------------------------------------------------------


class Reader(HTMLParser):
    """All elements with their attributes; AssertionError where tags do not match."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[str] = []
        self.scripts: list[str] = []
        self.feed(page)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        assert len(attrs) == len(dict(attrs)), f"an attribute twice: {attrs}"
        if tag not in VOID:
            self.open.append(tag)
        if tag == "script":
            self.scripts.append("")

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open, f"</{tag}> closes nothing"
        assert self.open.pop() == tag, f"</{tag}>"

    def handle_data(self, data: str) -> None:
        self.texts.append(data)
        if self.open and self.open[-1] == "script":
            self.scripts[-1] += data

    def all(self, name: str) -> list[str]:
        return [a[name] or "" for _, a in self.elements if name in a]

    def headings(self) -> list[str]:
        return [tag for tag, _ in self.elements if re.fullmatch("h[1-6]", tag)]


REPORTS: dict[str, Callable[[], Report]] = {
    "real": real,
    "proof only": lambda: report((scene(),)),
    "nothing": report,
    "names twice": lambda: report((scene(), scene()), claims=(claim(), claim())),
    "ragged details": lambda: report(
        claims=(claim(verdict=Verdict.REFUTED, details=(("a", "h = 1"), ("printed",), (), ("b",))),)
    ),
    "left range": lambda: report(
        (scene(runs=(run(status="left range", failed_step=7, values={}),)),)
    ),
    "undecided": lambda: report(
        (scene(proofs=(proof(verdict=Verdict.UNDECIDED, order=None, area_preserving=None),)),)
    ),
}


@cache
def page_of(name: str) -> str:
    return render(REPORTS[name]())


@pytest.mark.parametrize("name", REPORTS)
def test_the_page_is_well_formed_and_its_links_lead_somewhere(name: str) -> None:
    reader = Reader(page_of(name))
    ids = reader.all("id")
    assert len(ids) == len(set(ids))
    for target in reader.all("href"):
        assert target == "results.json" or target.removeprefix("#") in ids, target
    levels = [int(h[1]) for h in reader.headings()]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(b - a <= 1 for a, b in pairwise(levels))
    assert all("scope" in a for tag, a in reader.elements if tag == "th")


@pytest.mark.parametrize("name", REPORTS)
def test_the_page_needs_nothing_from_outside(name: str) -> None:
    page = page_of(name)
    reader = Reader(page)
    for tag, attributes in reader.elements:
        assert tag not in ("link", "img", "iframe", "object", "embed")
        for key, text in attributes.items():
            assert not re.search(r"https?:|//", text or ""), (tag, key, text)
            assert not key.startswith("on")
    assert reader.scripts == [SCRIPT]
    assert "@import" not in page
    assert not re.search(r'url\((?!#|"data:font)', page)


def test_the_pages_policy_lets_its_own_script_run_and_no_other() -> None:
    (script,) = Reader(page_of("real")).scripts
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    (policy,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', page_of("real"))
    assert f"script-src 'sha256-{digest}';" in policy
    assert "default-src 'none';" in policy


def test_what_others_wrote_stays_text() -> None:
    evil = report(
        (
            scene(
                name=EVIL, title=EVIL, hamiltonian=EVIL, parameters={EVIL: EVIL}, source=EVIL,
                proofs=(proof(scheme=EVIL, reason=EVIL, leading=EVIL, delta_j=EVIL, p_next=EVIL,
                              jacobian=((EVIL, EVIL), (EVIL, EVIL)), witness={EVIL: EVIL}),),
                runs=(run(scheme=EVIL, error_method=EVIL),),
            ),
        ),
        title=EVIL,
        claims=(claim(id=EVIL, source=EVIL, statement=EVIL, scene=EVIL, evidence=EVIL,
                      verdict=Verdict.REFUTED, details=((EVIL, EVIL), (EVIL, EVIL))),),
        left_out=((EVIL, EVIL),),
    )  # fmt: skip
    reader = Reader(render(evil))
    assert reader.scripts == [SCRIPT]
    assert "".join(reader.texts).count(EVIL) > 15


def test_every_claim_has_an_anchor_and_links_to_it() -> None:
    claims = tuple(claim(id=name) for name in ("eq-1", "eq-1-title", "a b", "a b", "”><b>", ""))
    reader = Reader(render(report((scene(),), claims=claims)))
    anchors = [i for i in reader.all("id") if i.startswith("claim-")]
    assert len(anchors) == len(claims)
    assert "claim-eq-1" in anchors
    assert {f"#{a}" for a in anchors} <= set(reader.all("href"))


def test_the_same_report_gives_the_same_page(tmp_path: Path) -> None:
    page = write(real(), tmp_path)
    assert page == tmp_path / "index.html"
    assert page.read_text(encoding="utf-8") == page_of("real")
    assert read_report(tmp_path / "results.json") == real()


def test_what_a_report_lacks_is_not_shown() -> None:
    page = render(report((scene(),)))
    ids = Reader(page).all("id")
    assert not {"claims", "left-out", "telling", "kinds"} & set(ids)
    assert not re.search(r"<svg|<table|Parameters:|T =", page)
    assert page.count("<details") == 2, "the contents and the terms"


def test_a_proof_is_shown_without_matplotlib() -> None:
    assert not {"matplotlib", "verify.pages.figures.step_size_figures"} & imported_by(
        "page_of('proof only')"
    )


# -- what the page says ---------------------------------------------------------------------------


def test_the_page_of_a_real_scene_says_what_was_found() -> None:
    text = " ".join(" ".join(Reader(page_of("real")).texts).replace("\xa0", " ").split())
    assert (
        "Of 2 claims, 1 is enclosed and 1 refuted; in Table 9, the printed row is lg(1/N) = "
        "lg(h/T) to all its digits; none of the 2 printed values is the lg MSE" in text
    )
    assert "Table 9, printed and computed" in text
    assert "h = 0.03 gives N = 6" in text  # 0.2/0.03 is not whole
    assert "Computed in float64 with N = 6 … 20 steps" in text
    assert "over time, h = 0.01 from q₀ = 1, p₀ = 0 (for Figure 3)" in text
    runs = real().scenes[0].runs
    for value in (v for r in runs for name, v in r.values.items() if name not in "pq"):
        shown = number(value.value).replace("\xa0", " ")
        assert re.search(rf"(?<![\d.]){re.escape(shown)}(?![\d.])", text), shown


def test_what_holds_for_every_h_is_shown_where_it_was_asked_for() -> None:
    asked = {"hamiltonian": "p**2/2 - cos(q)", "schemes": ["lie2", "rk4"], "name": "mine"}
    pages = []
    for every in (True, False):
        given = scene_from({**asked, "every_hamiltonian": every}, "mine.toml")
        made = make_report("Mine", [given], [], Store(None), command="test", where=THIS_PROCESS)
        pages.append(render(made))
    with_every, without = pages
    assert with_every.count("For every smooth H") == 2
    assert "X·G" in with_every
    assert with_every.count("The argument for every η at once, on paper") == 1
    assert with_every.count("not checked by machine") == 1
    assert "For every smooth H" not in without


def test_a_run_that_left_the_range_says_where() -> None:
    page = render(report((scene(runs=(run(status="left range", failed_step=7, values={}),)),)))
    assert "left the range of float64 at step 7" in page
