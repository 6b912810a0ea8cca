"""Tables that others write: their forms, and what is no table, told in a line that names a line."""

import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.helpers.programs.submitted_programs import Program
from verify.errors import InputError
from verify.reference.compare.published_data import Published, load
from verify.reference.compare.submitted_table import SubmittedTable, read
from verify.reference.make.data_folder import PUBLISHED

GIVEN = {"scene": "duffing", "scheme": "lie2", "step_size": "0.01", "q0": "1.5", "p0": "0"}
GOOD = Program().table()


@pytest.fixture(scope="module")
def ours() -> Published:
    return load(PUBLISHED, None)


@pytest.fixture
def table(ours: Published, tmp_path: Path) -> Callable[..., SubmittedTable]:
    def read_it(
        text: str | bytes, names: dict[str, str] | None = None, **given: str
    ) -> SubmittedTable:
        path = tmp_path / "theirs.csv"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return read(path, ours, given or GIVEN, names or {})

    return read_it


FORMS = {
    "commas": GOOD,
    "semicolons": GOOD.replace(",", ";"),
    "tabs": GOOD.replace(",", "\t"),
    "spaces": GOOD.replace(",", "   "),
    "a comment's mark before the header": "# " + GOOD.replace(",", " "),
    "comments and empty lines": "\n" + GOOD.replace("\n", "\n\n# so far\n"),
    "a mark of UTF-8": "\ufeff" + GOOD,
    "lines of Windows": GOOD.replace("\n", "\r\n"),
    "no last line end": GOOD.rstrip(),
    "other names": GOOD.replace("step,", "N,"),
    "quotes": GOOD.replace("1.5", '"1.5"'),
    "steps as floats": GOOD.replace("\n10,", "\n1.0e1,"),
    "times": GOOD.replace("step", "t").replace("\n1,", "\n0.01,").replace("\n10,", "\n0.1,")
    .replace("\n100,", "\n1.0000000000000007,"),
}  # fmt: skip


@pytest.mark.parametrize("form", FORMS)
def test_a_table_is_read_in_the_form_that_it_has(
    table: Callable[..., SubmittedTable], form: str
) -> None:
    found = table(FORMS[form])
    ((_, rows),) = found.runs.values()
    assert sorted(rows) == [0, 1, 10, 100]
    assert found.rows == 4
    assert found.outside == 0
    assert rows[0].cells == {"p": "0.0", "q": "1.5"}


def test_keys_are_columns_or_options(
    table: Callable[..., SubmittedTable], ours: Published, tmp_path: Path
) -> None:
    head, *lines = GOOD.splitlines()
    keyed = "\n".join([f"scheme,h,q0,p0,{head}", *(f"lie2,0.01,1.5,0,{x}" for x in lines)])
    assert table(keyed, scene="duffing").runs.keys() == table(GOOD).runs.keys()
    with pytest.raises(InputError, match=r"--scene: .*duffing, .*pendulum"):
        read(path_of(tmp_path, keyed), ours, {}, {})
    with pytest.raises(InputError, match=r"--scheme=.*is a column of the table, too"):
        table(keyed, scheme="lie2", scene="duffing")
    with pytest.raises(InputError, match=r"--step-size: .*0\.001, 0\.002"):
        table(GOOD, scene="duffing", scheme="lie2", q0="1.5", p0="0")


@pytest.mark.parametrize("q0", ["0.1", "1.5", "7"])
def test_an_input_of_which_the_scene_has_several_is_wanted(
    table: Callable[..., SubmittedTable], q0: str
) -> None:
    told = {name: x for name, x in GIVEN.items() if name != "p0"} | {"q0": q0}
    with pytest.raises(InputError, match=r"--p: .*no column of theirs.csv is p0; .*has: 0, 1\.5"):
        table(GOOD, **told)


def path_of(folder: Path, content: str) -> Path:
    path = folder / "keyed.csv"
    path.write_text(content)
    return path


def test_an_h_that_reads_as_the_same_double_is_taken_and_told(
    table: Callable[..., SubmittedTable],
) -> None:
    found = table(GOOD, **(GIVEN | {"step_size": "0.01000000000000000020816681711721685"}))
    assert len(found.runs) == 1
    assert set(found.read_as) == {"step_size"}
    assert table(GOOD, **(GIVEN | {"step_size": "0.01001"})).runs == {}


def test_columns_may_have_other_names(table: Callable[..., SubmittedTable]) -> None:
    renamed = GOOD.replace("step,p,q", "step,velocity,position")
    found = table(renamed, {"q": "position", "p": "velocity"})
    ((_, rows),) = found.runs.values()
    assert set(rows[0].cells) == {"p", "q"}
    assert table(renamed.replace("velocity", "p")).ignored == ("position",)
    with pytest.raises(InputError, match="momentum: is no column"):
        table(GOOD, {"p": "momentum"})
    with pytest.raises(InputError, match=r"pp: unknown; is p meant\? allowed: scene"):
        table(GOOD, {"pp": "p"})


def test_rows_that_the_data_do_not_have_are_counted(table: Callable[..., SubmittedTable]) -> None:
    found = table(Program().table(range(0, 12)))
    assert (found.rows, found.other_steps, found.outside) == (12, 9, 0)
    other = table(GOOD.replace("step,", "scheme,step,").replace("\n", "\nlie77,").rstrip("lie7,"),
                  **{name: x for name, x in GIVEN.items() if name != "scheme"})  # fmt: skip
    assert (other.other_steps, other.outside) == (0, 4)
    assert other.first_outside.startswith("line 2: scene = duffing, ")
    assert other.first_outside.endswith(", scheme = lie77")


def test_a_name_in_the_file_cannot_reach_the_terminal(table: Callable[..., SubmittedTable]) -> None:
    found = table(GOOD.replace("step,p,q", "step,p,\x1b[31mq"))
    assert found.ignored == ("\N{REPLACEMENT CHARACTER}[31mq",)
    long = table(GOOD.replace("step,p,q", f"step,p,{'q' * 500}"))
    assert len(long.ignored[0]) == 60


BAD = {
    "no file of text": (b"\x7fELF\0\0step,p\n", "NUL"),
    "another encoding": (GOOD.replace("step", "schritt für").encode("latin-1"), "UTF-8"),
    "sixteen bits": (GOOD.encode("utf-16"), "UTF-8"),
    "nothing": (b"", "is empty"),
    "no header": (GOOD.partition("\n")[2].encode(), "is no header"),
    "no column of numbers": (b"step,energy\n1,2\n", "names no column of p, q"),
    "no step": (b"p,q\n0,1.5\n", "names no column step or time"),
    "two steps": (b"step,n,p\n0,0,0\n", "two columns for step"),
    "a short line": (GOOD.encode() + b"1000,0.5", "line 6 has 2 cells"),
    "a step that is no number": (b"step,p\nten,1\n", "line 2 has the step 'ten'"),
    "a step in other digits": ("step,p\n١,1\n".encode(), "has the step '١'"),
    "a step with an underscore": (b"step,p\n1_0,1\n", "has the step '1_0'"),
    "half a step": (b"step,p\n1.5,1\n", "not a whole number"),
    "a huge step": (b"step,p\n1e999999999,1\n", "exponent beyond"),
    "a step twice, with other numbers": (GOOD.encode() + b"1,0,0\n", "other than line 3"),
    "an open quote": (b'step,p\n0,"1\n', "is not CSV"),
    "a very long line": (b"step,p\n0," + b"1" * 100_000 + b"\n", "line 2 has more than"),
    "very many columns": (b",".join([b"step"] * 1000) + b"\n", "1000 columns"),
}


@pytest.mark.parametrize("what", BAD)
def test_what_is_no_table_is_one_line_that_says_why(
    table: Callable[..., SubmittedTable], what: str
) -> None:
    content, problem = BAD[what]
    with pytest.raises(InputError, match=problem) as caught:
        table(content)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 300


@pytest.mark.left_to_ci
def test_a_long_table_is_not_held_in_memory(table: Callable[..., SubmittedTable]) -> None:
    lines = "".join(f"{n},0.123456789012345,1.23456789012345\n" for n in range(10_000, 40_000))
    content = (GOOD + lines).encode()
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    found = table(content)
    peak = tracemalloc.get_traced_memory()[1] - before
    tracemalloc.stop()
    assert found.rows == 30_004
    assert found.other_steps == 30_000
    assert peak < 2**20 < len(content)
