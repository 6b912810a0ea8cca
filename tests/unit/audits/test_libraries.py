"""The libraries of others: found by themselves, left out by name, and driven as they say."""

import sys
import tomllib
from importlib.machinery import ModuleSpec
from pathlib import Path
from typing import Any

import pytest

from tests.paths import ROOT
from verify.audits import integrators_report as others_report
from verify.audits import libraries as others
from verify.audits import library_claims
from verify.audits.integrators_report import make_integrators_report
from verify.audits.libraries.nodepy import _order_method, claimed_orders
from verify.audits.library_claims import claims_of
from verify.audits.methods.float_step import finding
from verify.audits.methods.integrator import FloatStep, LibraryComparison, ReleasedIntegrator
from verify.verdict import Verdict

LIBRARIES = [name for name in others.names() if others.get(name).LIBRARY is not None]


def hide(monkeypatch: pytest.MonkeyPatch, *kept: str) -> None:
    """As if no library but those were installed."""

    def find(name: str) -> ModuleSpec | None:
        return ModuleSpec(name, None) if name in kept else None

    monkeypatch.setattr(others, "find_spec", find)
    monkeypatch.setattr(library_claims, "files", list)


def test_every_file_says_what_it_is() -> None:
    assert {"scipy", "rebound", "literature"} <= set(others.names())
    assert others.get(others.names()[-1]).LIBRARY is None, "what needs no library comes last"
    for name in others.names():
        module = others.get(name)
        assert module.TITLE
        assert all(what and why for what, why in module.LEFT_OUT)


def test_libraries_that_are_not_installed_are_left_out_and_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    hide(monkeypatch)
    tables = others.get("literature")
    few = [
        x
        for x in tables.integrators()
        if x.name.startswith(("Ruth", "Yoshida 8, solution E", "Kahan"))
    ]
    monkeypatch.setattr(tables, "integrators", lambda: few)
    report = make_integrators_report("verify report integrators")
    missing = dict(report.left_out)
    for name in LIBRARIES:
        title = others.get(name).TITLE
        assert "not installed" in missing[title]
        assert title in report.preface[1]
        assert not any(claim.section.startswith(title) for claim in report.claims)
    assert report.preface[0].startswith("Installed here: none")
    assert report.claims, "printed tables need no library"
    ids = [claim.id for claim in report.claims]
    assert len(ids) == len(set(ids))
    wrong = [c for c in report.claims if c.verdict is Verdict.REFUTED]
    assert wrong
    assert all(c.reproduction for c in wrong)


def fails() -> Any:
    raise RuntimeError("no shared object")


def leaves() -> Any:
    raise SystemExit(3)


def breaks_off() -> Any:
    yield ReleasedIntegrator(
        "first", "by hand", "nowhere", LibraryComparison("it is itself", fails)
    )
    yield from others.get("literature").integrators()
    raise ValueError("cannot convert NaN to integer ratio")


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (fails, {"scipy": "is installed and fails: RuntimeError: no shared object"}),
        (leaves, {"scipy": "is installed and fails: SystemExit: 3"}),
        (
            breaks_off,
            {
                "scipy: first": "fails: RuntimeError: no shared object",
                "scipy": "is installed and fails: ValueError: cannot convert NaN to integer ratio",
            },
        ),
    ],
)
def test_a_library_that_fails_is_named_with_its_error_and_does_not_end_the_report(
    monkeypatch: pytest.MonkeyPatch, made: Any, said: dict[str, str]
) -> None:
    hide(monkeypatch, "scipy")
    tables = others.get("literature")
    one = [x for x in tables.integrators() if x.name == "Ruth 3"]
    monkeypatch.setattr(tables, "integrators", lambda: one)
    monkeypatch.setattr(others.get("scipy"), "integrators", made)
    monkeypatch.setattr(others_report, "import_module", lambda name: None)
    report = make_integrators_report("verify report integrators")
    left_out = dict(report.left_out)
    assert said.items() <= left_out.items()
    assert any(line.endswith("as they fail here: scipy.") for line in report.preface)
    own = [claim.source for claim in report.claims if claim.section.startswith("scipy")]
    assert own == (["Ruth 3"] if made is breaks_off else []), "what was found before is kept"
    assert any(claim.section == "printed tables" for claim in report.claims)


def test_a_library_that_cannot_be_imported_has_no_claims(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "galpy").mkdir()
    (tmp_path / "galpy" / "__init__.py").write_text("import nothing_of_that_name\n")
    for name in [name for name in sys.modules if name.partition(".")[0] == "galpy"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.syspath_prepend(str(tmp_path))
    hide(monkeypatch, "galpy")
    monkeypatch.setattr(others.get("literature"), "integrators", lambda: [])
    report = make_integrators_report("verify report integrators")
    said = dict(report.left_out)["galpy"]
    assert said.startswith("is installed and fails: ModuleNotFoundError")
    assert "nothing_of_that_name" in said
    assert not any(claim.section.startswith("galpy") for claim in report.claims)


def test_a_table_of_ours_that_fails_ends_the_report(monkeypatch: pytest.MonkeyPatch) -> None:
    hide(monkeypatch)
    monkeypatch.setattr(others.get("literature"), "integrators", fails)
    with pytest.raises(RuntimeError):
        make_integrators_report("verify report integrators")


def test_an_extra_installs_every_library() -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    extras = tomllib.loads(text)["project"]["optional-dependencies"]
    for name in LIBRARIES:
        module = others.get(name)
        extra = [entry.partition(">")[0] for entry in extras[getattr(module, "EXTRA", "peers")]]
        assert getattr(module, "PACKAGE", module.LIBRARY).lower() in extra
    assert any(entry.startswith("six") for entry in extras["peers"]), "nodepy does not ask for it"


def test_an_installed_library_has_its_version_told(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("scipy")
    from importlib.metadata import version

    assert others.installed_version("scipy") == version("scipy")
    hide(monkeypatch)
    assert others.installed_version("scipy") is None


@pytest.mark.parametrize(
    ("key", "name", "orders"),
    [
        ("RK44", "Classical RK4", (4, None)),
        ("SSP104", "SSPRK(10,4)", (4, None)),
        ("BuRK65", "Butcher's RK65", (5, None)),
        ("Fehlberg45", "Fehlberg RK5(4)6", (5, 4)),
        ("PD8", "Prince-Dormand 8(7)", (8, 7)),
        ("GL3", "Gauss-Legendre RK36", (6, None)),
        ("Nothing", "of no number", (None, None)),
    ],
)
def test_orders_are_read_from_the_names_of_nodepy(key: str, name: str, orders: Any) -> None:
    assert claimed_orders(key, name) == orders


@pytest.mark.parametrize(
    ("wrong", "coarse", "verdict"),
    [([], [], "PROVED"), ([], ["A: 4"], "MEASURED"), (["B: 1, and it is 2"], ["A: 4"], "REFUTED")],
)
def test_order_of_nodepy_is_not_blamed_for_the_tolerance_that_it_tells(
    wrong: list[str], coarse: list[str], verdict: str
) -> None:
    found, said, _ = _order_method(3, wrong, coarse, (("method",),))
    assert found.name == verdict
    assert all(x in said for x in wrong or coarse)


def integrators(name: str) -> dict[str, ReleasedIntegrator]:
    pytest.importorskip(others.get(name).LIBRARY)
    return {integrator.name: integrator for integrator in others.get(name).integrators()}


@pytest.mark.parametrize("name", LIBRARIES)
def test_integrators_have_names_of_their_own_and_reproductions_that_compile(name: str) -> None:
    pytest.importorskip(others.get(name).LIBRARY)
    found = list(others.get(name).integrators())
    assert len({integrator.name for integrator in found}) == len(found)
    for integrator in found:
        compile(integrator.reproduction, integrator.name, "exec")
        assert integrator.source
        assert integrator.driven


def test_tables_of_scipy_have_their_orders() -> None:
    found = integrators("scipy")
    for name in ("RK23, its table", "RK45, its table", "RK45, its error estimator"):
        (claim,) = claims_of(found[name], "scipy", "scipy")
        assert claim.verdict is Verdict.PROVED, claim.evidence
    (claim,) = claims_of(found["DOP853, its table"], "scipy", "scipy")
    assert claim.verdict is Verdict.MEASURED


def test_heyokas_taylor_step_is_lie_eta() -> None:
    found = integrators("heyoka")["Taylor and lieη"].method
    assert isinstance(found, LibraryComparison)
    verdict, evidence, rows = found.compare()
    assert verdict is Verdict.MEASURED, evidence
    assert len(rows) > 3


@pytest.mark.parametrize(
    ("units", "verdict"), [(0.9, "MEASURED"), (7.0, "UNDECIDED"), (1e6, "REFUTED")]
)
def test_a_rounding_that_is_a_little_worse_refutes_no_taylor_step(
    units: float, verdict: str
) -> None:
    assert others.get("heyoka")._verdict(units).name == verdict


def test_nodepys_lambert_is_of_order_two_and_its_misprint_is_found() -> None:
    found = integrators("nodepy")
    (claim,) = claims_of(found["Lambert65"], "nodepy", "nodepy")
    assert claim.verdict is Verdict.REFUTED
    assert "3/16, 1/16 in place of 1/8, 1/8" in claim.evidence


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("name", "integrator", "order"),
    [
        ("galpy", "symplec4_c", 4),
        ("rebound", "LEAPFROG, order 4", 4),
        ("rebound", "WHFAST", 2),
    ],
)
def test_symplectic_integrators_are_as_claimed(name: str, integrator: str, order: int) -> None:
    method = integrators(name)[integrator].method
    assert isinstance(method, FloatStep)
    found = finding(method)
    assert found.convergence_order == order
    assert found.area_preserving is True
