"""The kinds of claims: found by themselves, each one object with all that is asked of it."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

import pytest

from verify.claims import kinds
from verify.claims.base_claim import Claim, Findings
from verify.claims.claims_file import load_claims
from verify.claims.run_claims import RunClaim
from verify.discovery import Catalogue
from verify.errors import InputError
from verify.verdict import Verdict

PLANTED = """
from typing import Literal

from verify.claims.base_claim import Claim
from verify.verdict import Verdict


class Named(Claim):
    obstacle = "its name is its own"
    kind: Literal["named"]
    name: str

    def judge(self, findings):
        scene = findings.scene_of(self)
        holds = scene.name == self.name
        return self.result(Verdict.PROVED if holds else Verdict.REFUTED, f"it is {scene.name}")


CLAIM = Named
"""


@pytest.fixture
def planted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of kinds with one more than there are."""
    (tmp_path / "named.py").write_text(PLANTED)
    monkeypatch.setattr(
        kinds, "_FILES", Catalogue(kinds.__name__, [*kinds.__path__, str(tmp_path)])
    )
    monkeypatch.setattr(kinds, "__path__", [*kinds.__path__, str(tmp_path)])
    kinds.models.cache_clear()
    yield tmp_path
    kinds.models.cache_clear()
    sys.modules.pop(f"{kinds.__name__}.named", None)


def test_each_file_has_a_kind_and_no_name_is_given_twice() -> None:
    files = [kinds._FILES.module(name).CLAIM for name in kinds._FILES.names]
    names = [n for m in files for n in get_args(m.model_fields["kind"].annotation)]
    assert sorted(names) == list(kinds.models())
    assert all(issubclass(model, Claim) for model in files)


def test_what_runs_decide_is_not_exact_and_has_keys_of_runs() -> None:
    for model in kinds.models().values():
        assert issubclass(model, RunClaim) == bool(model.run_keys)
        assert not (model.exact and model.run_keys)


def claims_file(folder: Path, name: str) -> Path:
    path = folder / "claims.toml"
    path.write_text(
        f'[[claim]]\nid = "c"\nkind = "named"\nscheme = "lie2"\nname = "{name}"\n'
        'hamiltonian = "p**2/2 + q**2/2"\nstatement = "It is `c^2`."\n'
    )
    return path


@pytest.mark.parametrize(("name", "verdict"), [("c", Verdict.PROVED), ("d", Verdict.REFUTED)])
def test_a_planted_kind_is_found_and_judged(planted: Path, name: str, verdict: Verdict) -> None:
    file = load_claims(claims_file(planted, name))
    found = file.claims[0].judge(Findings(file.scenes))
    assert (found.kind, found.verdict, found.evidence) == ("named", verdict, "it is c")
    assert found.statement.parts == ("It is ", "c^2", ".")
    assert file.claims[0].why_not_transferable() == "its name is its own"


def test_without_its_file_the_kind_is_unknown(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="kind=named: unknown; allowed: alike, area_preserving, "):
        load_claims(claims_file(tmp_path, "c"))
