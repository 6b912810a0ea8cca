"""What explains several statements: what a file may say of it, and when a report tells it."""

from pathlib import Path

import pytest

from verify.claims.claims_file import load_claims
from verify.claims.verdicts import make_report
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.prose import Formula

HEAD = """
[defaults]
scheme = "lie2"
system = "harmonic"
kind = "defect_order"
[[claim]]
id = "a"
defect_order = 3
statement = "It is of order 3."
reading = "so"
[[claim]]
id = "b"
defect_order = 4
statement = "It is of order 4."
[[claim]]
id = "ours"
defect_order = 4
standing = "ours"
remark = "This is `h^4`."
confirmed_by = "tests/second/test_me.py"
[[claim]]
id = "wrong"
defect_order = 5
standing = "ours"
"""


def written(folder: Path, cause: str) -> Path:
    path = folder / "claims.toml"
    path.write_text(f"{HEAD}[[cause]]\n{cause}\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("cause", "told"),
    [
        ('says = "It is `h^4`."\nexplains = ["a"]', True),
        ('says = "It is `h^4`."\nexplains = ["a"]\nshown_by = ["ours"]', True),
        ('says = "It is `h^4`."\nexplains = ["a"]\nshown_by = ["ours", "wrong"]', False),
        ('says = "It is `h^4`."\nexplains = ["a", "b"]', False),
    ],
)
def test_a_cause_is_told_where_it_is_shown_and_nothing_that_it_explains_holds(
    tmp_path: Path, cause: str, told: bool
) -> None:
    file = load_claims(written(tmp_path, cause))
    report = make_report(
        "x", (), file.claims, Store(None), command="x", claim_scenes=file.scenes,
        causes=file.causes, where=THIS_PROCESS,
    )  # fmt: skip
    assert [str(each.says) for each in report.causes] == ["It is h^4."] * told
    (ours,) = (claim for claim in report.claims if claim.id == "ours")
    assert (ours.remark, ours.confirmed_by) == ("This is h^4.", "tests/second/test_me.py")


def test_a_cause_may_say_whom_it_disfavours_and_how_it_came_about(tmp_path: Path) -> None:
    more = 'disfavours = "The authors, by `h^2`."\norigin = "One of the `N` is 0."'
    (cause,) = load_claims(written(tmp_path, f'says = "x"\nexplains = ["a"]\n{more}')).causes
    assert cause.disfavours.parts == ("The authors, by ", Formula("h^2"), ".")
    assert cause.origin.parts == ("One of the ", Formula("N"), " is 0.")


def test_a_cause_says_nothing_of_that_by_itself(tmp_path: Path) -> None:
    (cause,) = load_claims(written(tmp_path, 'says = "x"\nexplains = ["a"]')).causes
    assert (cause.disfavours, cause.origin) == ("", "")


@pytest.mark.parametrize(
    ("cause", "problem"),
    [
        ('explains = ["a"]', "says: is a sentence; none stands here"),
        ('says = 3\nexplains = ["a"]', "says=3: is a sentence; none stands here"),
        ('says = "x"', "explains"),
        ('says = "x"\nexplains = []', "explains"),
        ('says = "x"\nexplains = ["ours"]', "explains=ours: is no id of a statement"),
        ('says = "x"\nexplains = ["c"]', "explains=c: is no id of a statement"),
        ('says = "x"\nexplains = ["a"]\nshown_by = ["c"]', "shown_by=c: is no id of a claim"),
        ('says = "x"\nexplains = ["a"]\nbecause = "y"', "because"),
        ('says = "x"\nexplains = ["a"]\ndisfavours = 3', "disfavours=3: is a sentence"),
        ('says = "x"\nexplains = ["a"]\norigin = ["y"]', "origin=['y']: is a sentence"),
    ],
)
def test_what_cannot_be_said_of_a_cause_is_named_with_its_line(
    tmp_path: Path, cause: str, problem: str
) -> None:
    with pytest.raises(InputError) as error:
        load_claims(written(tmp_path, cause))
    assert "claims.toml:25: cause: " in str(error.value)
    assert problem in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("value", ["3", '"x"', "{ says = 1 }"])
def test_causes_are_tables(tmp_path: Path, value: str) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(f"cause = {value}\n{HEAD}", encoding="utf-8")
    with pytest.raises(InputError, match=r"claims.toml: cause=.*: write \[\[cause\]\] tables"):
        load_claims(path)
    path.write_text(f"cause = [{value}]\n{HEAD}", encoding="utf-8")
    with pytest.raises(InputError, match=r"cause: says.*is a sentence"):
        load_claims(path)
