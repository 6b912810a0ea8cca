"""Tables that others write: their forms, and what is no table, told in a line that names a line."""

import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.helpers.programs.submitted_programs import HeilesProgram, Program
from verify.errors import InputError
from verify.reference.compare.comparison import compare
from verify.reference.compare.published_data import Published, load
from verify.reference.compare.submitted_table import SubmittedTable, has_degrees, read
from verify.reference.make.data_folder import PUBLISHED

GIVEN = {"scene": "duffing", "scheme": "lie2", "step_size": "0.01", "q0": "1.5", "p0": "0"}
HEILES_RUN = {"scene": "heiles", "scheme": "lie2"}
GOOD = Program().table()
HEILES = HeilesProgram().table()
Reader = Callable[..., SubmittedTable]


@pytest.fixture(scope="module")
def ours() -> Published:
    return load(PUBLISHED, None)


@pytest.fixture
def table(ours: Published, in_degrees: Published, tmp_path: Path) -> Reader:
    """Reads a table of the data in the plane, or of those `of` n degrees of freedom."""

    def read_it(
        text: str | bytes, names: dict[str, str] | None = None, *, planar: bool = True, **given: str
    ) -> SubmittedTable:
        path = tmp_path / "theirs.csv"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        options = given or (GIVEN if planar else HEILES_RUN)
        return read(path, ours if planar else in_degrees, options, names or {})

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
def test_a_table_is_read_in_the_form_that_it_has(table: Reader, form: str) -> None:
    found = table(FORMS[form])
    ((_, rows),) = found.runs.values()
    assert sorted(rows) == [0, 1, 10, 100]
    assert found.rows == 4
    assert found.outside == 0
    assert rows[0].cells == {"p": "0.0", "q": "1.5"}


def keyed(text: str, keys: str, values: str) -> str:
    """The table with columns before its own, that are the same in every row."""
    head, *lines = text.splitlines()
    return "\n".join([f"{keys},{head}", *(f"{values},{x}" for x in lines)])


def test_keys_are_columns_or_options(table: Reader) -> None:
    by_columns = table(keyed(GOOD, "scheme,h,q0,p0", "lie2,0.01,1.5,0"), scene="duffing")
    assert by_columns.runs.keys() == table(GOOD).runs.keys()


def without(name: str, **changes: str) -> dict[str, str]:
    return {n: x for n, x in (GIVEN | changes).items() if n != name}


@pytest.mark.parametrize(
    ("text", "options", "problem"),
    [
        (keyed(GOOD, "scheme,h,q0,p0", "lie2,0.01,1.5,0"), {}, r"--scene: .*duffing, .*pendulum"),
        (HEILES, {}, r"--scene.*is wanted: 2 have such runs: heiles, three"),
        (HEILES, {"scene": "none"}, r"scene=none: unknown; .*allowed: "),
        (HEILES, {"scene": "heiles"}, r"--scheme.*is wanted"),
        (keyed(GOOD, "scheme", "lie2"), GIVEN, r"--scheme=.*is a column of the table, too"),
        (keyed(HEILES, "scheme", "lie2"), HEILES_RUN,
         r"--scheme=lie2: is a column of the table, too"),
        (GOOD, without("step_size"), r"--step-size: .*0\.001, 0\.002"),
        *((GOOD, without("p0", q0=q0), r"--p: .*no column of theirs.csv is p0; .*has: 0, 1\.5")
          for q0 in ("0.1", "1.5", "7")),
    ],
    ids=["no scene", "no scene in degrees", "an unknown scene", "no scheme", "a scheme twice",
         "a scheme twice in degrees", "no step size", "no p, q = 0.1", "no p, q = 1.5",
         "no p, q = 7"],
)  # fmt: skip
def test_options_that_do_not_tell_the_run_are_refused(
    ours: Published, in_degrees: Published, tmp_path: Path, text: str, options: dict[str, str],
    problem: str,
) -> None:  # fmt: skip
    path = tmp_path / "theirs.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=problem):
        read(path, in_degrees if has_degrees(path, {}) else ours, options, {})


@pytest.mark.parametrize(("text", "several"), [(GOOD, False), (HEILES, True)])
def test_by_its_columns_a_table_is_of_the_plane_or_not(
    tmp_path: Path, text: str, several: bool
) -> None:
    path = tmp_path / "theirs.csv"
    path.write_text(text)
    assert has_degrees(path, {}) is several


def test_inputs_in_degrees_may_be_left_out_where_the_others_leave_one_run(tmp_path: Path) -> None:
    henon = load(PUBLISHED, "several-henon-heiles", planar=False)
    path = tmp_path / "mine.csv"
    path.write_text("step,p1\n0,0.4\n")
    options = {"scheme": "lie2", "step_size": "0.1", "q0": "0,0.1"}
    assert list(read(path, henon, options, {}).runs) == [
        "several-henon-heiles: lie2, h = 0.1, q = (0, 0.1), p = (0.4, 0)"
    ]
    with pytest.raises(InputError, match=r"--q: is wanted, .* has: 0.1, -0.1"):
        read(path, henon, {"scheme": "lie2"}, {})
    none = read(path, henon, {"step_size": "0.07"}, {})
    assert (none.outside, none.runs) == (1, {})


@pytest.mark.parametrize(
    ("planar", "options"),
    [
        (True, GIVEN | {"step_size": "0.01001"}),
        (False, HEILES_RUN | {"step_size": "0.07"}),
        (False, HEILES_RUN | {"q0": "0.3,0.1,0", "p0": "0,1/3,0"}),
    ],
    ids=["another h", "another h in degrees", "more degrees"],
)
def test_inputs_of_no_run_leave_no_rows(
    table: Reader, planar: bool, options: dict[str, str]
) -> None:
    submitted = table(GOOD if planar else HEILES, planar=planar, **options)
    assert (submitted.runs, submitted.outside) == ({}, submitted.rows)
    with pytest.raises(InputError, match="has no row of these data"):
        submitted.all_rows()


NEARLY = "0.01000000000000000020816681711721685"  # the double nearest to 0.01


@pytest.mark.parametrize(
    ("planar", "options", "read_as", "label"),
    [
        (True, GIVEN | {"step_size": NEARLY}, "step_size",
         "duffing: lie2, h = 0.01, (q, p) = (1.5, 0)"),
        (False, {"scheme": "lie2", "q0": "0.3, 0.1", "p0": "0,0.3333333333333333"}, "p0_2",
         "heiles: lie2, h = 0.05, q = (0.3, 0.1), p = (0, 1/3)"),
    ],
    ids=["h", "lists in degrees"],
)  # fmt: skip
def test_inputs_that_read_as_the_same_doubles_are_taken_and_told(
    table: Reader, ours: Published, in_degrees: Published, planar: bool, options: dict[str, str],
    read_as: str, label: str,
) -> None:  # fmt: skip
    submitted = table(GOOD if planar else HEILES, planar=planar, **options)
    assert [run.label for run, _ in submitted.runs.values()] == [label]
    assert set(submitted.read_as) == {read_as}
    assert compare(ours if planar else in_degrees, submitted).agrees


def test_columns_may_have_other_names(table: Reader) -> None:
    renamed = GOOD.replace("step,p,q", "step,velocity,position")
    found = table(renamed, {"q": "position", "p": "velocity"})
    ((_, rows),) = found.runs.values()
    assert set(rows[0].cells) == {"p", "q"}
    assert table(renamed.replace("velocity", "p")).ignored == ("position",)
    with pytest.raises(InputError, match="momentum: is no column"):
        table(GOOD, {"p": "momentum"})
    with pytest.raises(InputError, match=r"pp: unknown; is p meant\? allowed: scene"):
        table(GOOD, {"pp": "p"})


def test_rows_that_the_data_do_not_have_are_counted(table: Reader) -> None:
    found = table(Program().table(range(0, 12)))
    assert (found.rows, found.other_steps, found.outside) == (12, 9, 0)
    other = table(GOOD.replace("step,", "scheme,step,").replace("\n", "\nlie77,").rstrip("lie7,"),
                  **{name: x for name, x in GIVEN.items() if name != "scheme"})  # fmt: skip
    assert (other.other_steps, other.outside) == (0, 4)
    assert other.first_outside.startswith("line 2: scene = duffing, ")
    assert other.first_outside.endswith(", scheme = lie77")


def test_a_name_in_the_file_cannot_reach_the_terminal(table: Reader) -> None:
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
    "no step in degrees": (b"p1,q1\n0,0\n", "names no column step or time"),
    "two steps": (b"step,n,p\n0,0,0\n", "two columns for step"),
    "a short line": (GOOD.encode() + b"1000,0.5", "line 6 has 2 cells"),
    "a step that is no number": (b"step,p\nten,1\n", "line 2 has the step 'ten'"),
    "a step in other digits": ("step,p\n١,1\n".encode(), "has the step '١'"),
    "a step with an underscore": (b"step,p\n1_0,1\n", "has the step '1_0'"),
    "half a step": (b"step,p\n1.5,1\n", "not a whole number"),
    "half a step in degrees": (b"step,p1,q1\n1.5,0,0\n", "which is not a whole number"),
    "a huge step": (b"step,p\n1e999999999,1\n", "exponent beyond"),
    "a step twice, with other numbers": (GOOD.encode() + b"1,0,0\n", "other than line 3"),
    "an open quote": (b'step,p\n0,"1\n', "is not CSV"),
    "a very long line": (b"step,p\n0," + b"1" * 100_000 + b"\n", "line 2 has more than"),
    "very many columns": (b",".join([b"step"] * 1000) + b"\n", "1000 columns"),
}


@pytest.mark.parametrize("what", BAD)
def test_what_is_no_table_is_one_line_that_says_why(table: Reader, what: str) -> None:
    content, problem = BAD[what]
    with pytest.raises(InputError, match=problem) as caught:
        table(content, planar="in degrees" not in what)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 300


@pytest.mark.left_to_ci
def test_a_long_table_is_not_held_in_memory(table: Reader) -> None:
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
