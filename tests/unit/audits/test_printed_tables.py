"""Tables in the sources of libraries: their claims, and what is wrong shown by plain steps."""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.tables.by_series import gap
from verify.audits.library_claims import claims_of_tables, files
from verify.audits.mistake import descriptions
from verify.integrators.tables.cost import Severity
from verify.integrators.tables.table_file import read_tables
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

SOME = 16  # of so many tables one is judged here; all are by `verify report integrators`
# Splittings whose clocks are judged besides, and those of order 1 in time as in the sources.
CLOCKS = ("SPRK_LEAPFROG", "SPRK_CANDY", "SPRK_MCLACHLAN_4", "PseudoVerletLeapfrog", "McAte4",
          "CalvoSanz4", "SYMPLECTICVELVERLET", "TableauRK42", "BPR3", "RKM")  # fmt: skip


@cache
def of_some(path: Path) -> list[ClaimResult]:
    whole = read_tables(path)
    chosen = [
        pair
        for k, pair in enumerate(whole.entries)
        if k % SOME == 0 or any(name in pair[0].name for name in CLOCKS)
    ]
    return list(claims_of_tables(replace(whole, entries=tuple(chosen))))


def test_every_file_is_read_and_names_its_version_and_where_it_was_read() -> None:
    assert len(files()) >= 9
    for path in files():
        found = read_tables(path)
        assert any(sign.isdigit() for sign in found.title), "a version, or a date"
        for entry, _ in found.entries:
            assert entry.source
            assert entry.read, entry.name


@pytest.mark.left_to_ci
@pytest.mark.parametrize("path", files(), ids=lambda path: path.stem)
def test_what_is_refuted_is_told_of_in_a_finding_or_is_digits(path: Path) -> None:
    claims = of_some(path)
    told = descriptions().values()
    for claim in claims:
        if claim.verdict is Verdict.REFUTED:
            assert claim.severity in tuple(Severity)
            assert "digits" in claim.severity or any(x.tells_of(claim.id) for x in told), claim.id
        else:
            assert not claim.severity
    assert len({c.id for c in claims}) == len(claims)


WITHDRAWN = "FRK65", "PFRK87"


def test_what_upstream_has_mended_is_told_and_is_nobodys_accusation() -> None:
    (path,) = (path for path in files() if path.stem == "ordinarydiffeq-rk")
    found = read_tables(path)
    told = [why for what, why in found.left_out if all(name in what for name in WITHDRAWN)]
    assert len(told) == 1
    assert all(number in told[0] for number in ("#4403", "#4404"))
    own = tuple(pair for pair in found.entries if pair[0].name in (*WITHDRAWN, "SIR54"))
    claims = {claim.id: claim.verdict for claim in claims_of_tables(replace(found, entries=own))}
    refuted = [name for name, verdict in claims.items() if verdict is Verdict.REFUTED]
    assert refuted == ["OrdinaryDiffEq/SIR54/embedded order"], "the control, which is not mended"
    assert claims["OrdinaryDiffEq/FRK65/order"] is Verdict.MEASURED
    for name, told_of in descriptions().items():
        for withdrawn in WITHDRAWN:
            assert not told_of.tells_of(f"OrdinaryDiffEq/{withdrawn}/embedded order"), name


def test_what_upstream_knows_and_where_the_order_ends_is_said_of_sir54() -> None:
    holds = descriptions()["ordinarydiffeq-sir54-estimate"].holds
    assert "Upstream knows: OrdinaryDiffEq #4403" in holds
    assert "of order 5 for a quadratic right-hand side" in holds
    assert "of order 4 for any other" in holds


@pytest.mark.parametrize("name", ["sundials", "ordinarydiffeq", "petsc"])
def test_a_wrong_clock_is_shown_by_plain_code(name: str) -> None:
    """The slopes of the error of one step end at 2, that of order 1."""
    (path,) = (path for path in files() if path.stem == name)
    clocks = [c for c in of_some(path) if c.severity == "wrong clock"]
    assert clocks
    for claim in clocks:
        told: list[Any] = []
        names = {"print": told.append, "__name__": "page"}
        exec(compile(claim.reproduction, claim.id, "exec"), names)  # noqa: S102 - our own
        assert abs(told[0][-1][1] - 2) < 0.3, claim.id
        assert "a second look, by steps at 60 digits, shows order 1" in str(claim.evidence)


def test_the_series_of_a_leapfrog_with_sundials_clock_part_from_the_flow() -> None:
    table = {"kind": "splitting", "order": 2, "first": "kick", "sizes": ["0", "1/2", "1", "1/2"],
             "times": ["0", "1/2", "1", "1"], "time_dependent": "T and V"}  # fmt: skip
    assert gap(table, 2, timed=True) > 1
    assert gap({**table, "times": ["0", "0", "1/2", "1"]}, 2, timed=True) == 0
    assert math.isclose(gap(table, 1, timed=True), 0)
