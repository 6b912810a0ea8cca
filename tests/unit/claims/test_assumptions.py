"""What a paper leaves open: what a claims file may say of it, and what a report takes over."""

from pathlib import Path
from typing import Any

import pytest

from verify.claims.claims_file import load_claims
from verify.claims.verdicts import make_report
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.prose import Formula, read_prose
from verify.scenes.paper_sections import Alternative, Assumption
from verify.scenes.results.report import read_report

HEAD = """
[defaults]
scheme = "lie2"
system = "harmonic"
kind = "defect_order"
[[claim]]
id = "a"
defect_order = 4
statement = "It is of order 4."
reading = "so"
[[claim]]
id = "b"
defect_order = 3
reading_of = "a"
reading = "otherwise"
[[claim]]
id = "ours"
defect_order = 4
standing = "ours"
"""
PAIR = 'decides = [{ claim = "a", otherwise = "b" }]'
FULL = f"""
says = "The step is `h/2`."
silence = "No step size is printed, and `h^2` is."
{PAIR}
settled_by = ["ours"]
"""


def written(folder: Path, *assumptions: str) -> Path:
    path = folder / "claims.toml"
    tables = "".join(f"[[assumption]]\n{lines.strip()}\n" for lines in assumptions)
    path.write_text(HEAD + tables, encoding="utf-8")
    return path


# -- what is right --------------------------------------------------------------------------------


def test_an_assumption_has_its_sentences_with_their_formulas(tmp_path: Path) -> None:
    (assumption,) = load_claims(written(tmp_path, FULL)).assumptions
    assert assumption.says.parts == ("The step is ", Formula("h/2"), ".")
    assert assumption.silence.parts == ("No step size is printed, and ", Formula("h^2"), " is.")
    assert assumption.decides == (Alternative(claim="a", otherwise="b"),)
    assert assumption.settled_by == ("ours",)


def test_assumptions_stand_in_the_order_of_the_file(tmp_path: Path) -> None:
    one, other = f'says = "One."\n{PAIR}', 'says = "Another."\nsettled_by = ["ours"]'
    file = load_claims(written(tmp_path, one, other))
    assert [(a.says, a.silence, a.settled_by) for a in file.assumptions] == [
        ("One.", "", ()), ("Another.", "", ("ours",)),
    ]  # fmt: skip


def test_a_report_and_its_json_have_the_assumptions_of_the_file(tmp_path: Path) -> None:
    file = load_claims(written(tmp_path, FULL, f'says = "One."\n{PAIR}'))
    report = make_report(
        "x", (), file.claims, Store(None), command="x", claim_scenes=file.scenes,
        assumptions=file.assumptions, where=THIS_PROCESS,
    )  # fmt: skip
    assert report.assumptions == tuple(file.assumptions)
    path = tmp_path / "results.json"
    path.write_text(report.model_dump_json())
    again = read_report(path)
    assert again == report
    assert again.assumptions[0].says.parts == ("The step is ", Formula("h/2"), ".")


def test_a_report_keeps_what_repairs_and_its_effect_in_its_json(tmp_path: Path) -> None:
    path = written(tmp_path)
    text = path.read_text().replace('"otherwise"\n', '"otherwise"\nrepaired = "It is `h^3`."\n')
    path.write_text(text + 'repairs = "a"\neffect = "conclusion"\n', encoding="utf-8")
    file = load_claims(path)
    report = make_report(
        "x", (), file.claims, Store(None), command="x", claim_scenes=file.scenes,
        not_claimed=[("Appendix", "It states nothing.")], where=THIS_PROCESS,
    )  # fmt: skip
    (tmp_path / "results.json").write_text(report.model_dump_json())
    again = read_report(tmp_path / "results.json")
    assert again == report
    assert [(c.repairs, c.effect) for c in again.claims] == [
        ("", ""), ("a", ""), ("a", "conclusion"),
    ]  # fmt: skip
    assert again.claims[1].repaired.parts == ("It is ", Formula("h^3"), ".")
    assert again.not_claimed == again.left_out == (("Appendix", "It states nothing."),)


# -- mistakes -------------------------------------------------------------------------------------

SAYS = read_prose("It is so.")


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({}, "decides: or `settled_by` names the claims concerned"),
        ({"decides": (("c", "b"),)}, "decides=c: is no id of a claim of this file"),
        ({"decides": (("a", "c"),)}, "decides=c: is no id of a claim of this file"),
        ({"decides": (("a", "b"), ("a", "c"))}, "decides=c: is no id of a claim of this file"),
        ({"settled_by": ("c",)}, "settled_by=c: is no id of a claim of this file"),
        ({"decides": (("a", "b"),), "settled_by": ("a", "c")}, "settled_by=c: is no id of a claim"),
    ],
)
def test_an_assumption_on_a_claim_that_is_not_there_is_refused(
    keys: dict[str, Any], message: str
) -> None:
    pairs = tuple(Alternative(claim=one, otherwise=other) for one, other in keys.get("decides", ()))
    assumption = Assumption(says=SAYS, **(keys | {"decides": pairs}))
    with pytest.raises(InputError) as error:
        assumption.check({"a", "b"})
    assert str(error.value).startswith(message)


def test_an_assumption_on_claims_that_are_there_is_taken() -> None:
    pair = Alternative(claim="a", otherwise="b")
    Assumption(says=SAYS, decides=(pair,)).check({"a", "b"})
    Assumption(says=SAYS, settled_by=("b",)).check({"a", "b"})


WRONG = {
    "nothing-said": (PAIR, "says: is a sentence; none stands here"),
    "empty": (f'says = ""\n{PAIR}', "says: is a sentence; none stands here"),
    "a-number": (f"says = 3\n{PAIR}", "says=3: is a sentence; none stands here"),
    "no-claims": ('says = "x"', "decides: or `settled_by` names the claims concerned"),
    "empty-lists": ('says = "x"\ndecides = []\nsettled_by = []', "decides: or `settled_by` names"),
    "silence-a-number": (f'says = "x"\nsilence = 3\n{PAIR}', "silence=3: is a sentence"),
    "unknown-claim": (
        'says = "x"\ndecides = [{ claim = "a", otherwise = "c" }]', "decides=c: is no id of a claim"
    ),
    "unknown-settling": ('says = "x"\nsettled_by = ["c"]', "settled_by=c: is no id of a claim"),
    "half-a-pair": ('says = "x"\ndecides = [{ claim = "a" }]', "otherwise"),
    "a-list": ('says = "x"\ndecides = ["a", "b"]', "decides"),
    "settled-by-a-word": ('says = "x"\nsettled_by = "ours"', "settled_by"),
    "unknown-key": (f'says = "x"\n{PAIR}\nbecause = "y"', "because=y: unknown key"),
}  # fmt: skip


@pytest.mark.parametrize(("lines", "problem"), WRONG.values(), ids=WRONG)
def test_what_is_wrong_in_an_assumption_is_named_with_its_line(
    tmp_path: Path, lines: str, problem: str
) -> None:
    with pytest.raises(InputError) as error:
        load_claims(written(tmp_path, lines))
    assert str(error.value).startswith("claims.toml:20: assumption: ")
    assert problem in str(error.value)
    assert "\n" not in str(error.value)


def test_the_line_is_that_of_the_assumption_that_is_wrong(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"claims\.toml:25: assumption: says"):
        load_claims(written(tmp_path, FULL, PAIR))


@pytest.mark.parametrize("value", ["3", '"x"', "{ says = 1 }"])
def test_assumptions_are_tables(tmp_path: Path, value: str) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(f"assumption = {value}\n{HEAD}", encoding="utf-8")
    with pytest.raises(InputError, match=r"assumption=.*: write \[\[assumption\]\] tables"):
        load_claims(path)
    path.write_text(f"assumption = [{value}]\n{HEAD}", encoding="utf-8")
    with pytest.raises(InputError, match=r"assumption: says.*is a sentence"):
        load_claims(path)
