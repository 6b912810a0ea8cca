"""Files of tables: mistakes told with their lines, what is pasted, and files beside them."""

from pathlib import Path

import pytest

from verify.errors import InputError
from verify.integrators.tables.table_file import check_table, read_tables
from verify.verdict import Verdict

GOOD = """title = "x"
[[table]]
name = "a"
kind = "splitting"
order = 2
first = "kick"
sizes = ["1/2", "1", "1/2"]
"""


@pytest.mark.parametrize(
    ("before", "after", "line", "message"),
    [
        ('kind = "splitting"', 'kind = "spliting"', 4, "splitting"),
        ('kind = "splitting"\n', "", 2, "kind"),
        ("order = 2", "order = 0", 5, "must be 1 or more"),
        ("order = 2", "order = 9", 5, "up to 8"),
        ("order = 2\n", "", 2, "order"),
        ('first = "kick"', 'first = "kik"', 6, "kick"),
        ('first = "kick"\n', "", 2, "first"),
        ('sizes = ["1/2", "1", "1/2"]', 'sizes = ["1/2", "1/0", "1/2"]', 7, "1/0"),
        ('sizes = ["1/2", "1", "1/2"]', 'sizes = ["1/2", "x", "1/2"]', 7, "x"),
        ('sizes = ["1/2", "1", "1/2"]', "sizes = []", 7, "sizes"),
        ('sizes = ["1/2", "1", "1/2"]\n', "", 2, "sizes"),
        ("order = 2", 'order = 2\ntimes = ["0"]', 6, "3, one for each size"),
        ("order = 2", "order = 2\nsize = 3", 6, "sizes"),
        ("[[table]]", "[[tables]]", 2, "unknown"),
        ("order = 2", "order = 2\nsymplectic = 1", 6, "true or false"),
        ("order = 2", "order = 2\nnumbers = { sin = 1 }", 6, "sin"),
    ],
)
def test_a_mistake_is_told_with_its_line(
    tmp_path: Path, before: str, after: str, line: int, message: str
) -> None:
    assert before in GOOD
    path = tmp_path / "tables.toml"
    path.write_text(GOOD.replace(before, after), encoding="utf-8")
    with pytest.raises(InputError, match=message) as error:
        check_table(path)
    assert f"tables.toml:{line}" in str(error.value), error.value
    assert "\n" not in str(error.value)


def test_a_name_stands_once(tmp_path: Path) -> None:
    path = tmp_path / "t.toml"
    path.write_text(GOOD + GOOD.partition("\n")[2], encoding="utf-8")
    with pytest.raises(InputError, match="twice"):
        read_tables(path)


def test_pasted_tableaus_and_files_are_the_same_tables(tmp_path: Path) -> None:
    (tmp_path / "rk.csv").write_text("0\n½,½\n1,−1,2\n,1/6,2/3,1/6\n", encoding="utf-8")
    (tmp_path / "s.csv").write_text("kind,size,time\nkick,0.5,0\ndrift,1,-\nkick,0.5,1\n")
    path = tmp_path / "t.toml"
    path.write_text(
        '[[table]]\nname = "a"\nkind = "runge-kutta"\norder = 3\ncsv = "rk.csv"\n'
        '[[table]]\nname = "b"\nkind = "splitting"\norder = 2\ncsv = "s.csv"\n'
        '[[table]]\nname = "c"\nkind = "runge-kutta"\norder = 3\ntableau = """\n'
        "0 & \\\\\\\\\n\\\\frac12 & \\\\frac12 \\\\\\\\\n1 & -1 & 2 \\\\\\\\ \\\\hline\n"
        ' & \\\\frac16 & \\\\frac23 & \\\\frac16\n"""\n',
        encoding="utf-8",
    )
    found = {each.id: each.claim.verdict for each in check_table(path)}
    assert set(found.values()) == {Verdict.PROVED}
    assert {"a/order", "a/row sums", "b/order in time", "c/order in time"} <= set(found)


def test_the_weights_of_a_composition_may_be_in_a_csv_file(tmp_path: Path) -> None:
    """Three times as many steps of a third: of order 2; what stands beside the file is refused."""
    (tmp_path / "w.csv").write_text("size\n1/3\n1/3\n1/3\n", encoding="utf-8")
    path = tmp_path / "t.toml"
    entry = '[[table]]\nname = "a"\nkind = "composition"\norder = 2\ncsv = "w.csv"\n'
    path.write_text(entry, encoding="utf-8")
    found = {each.id: each.claim.verdict for each in check_table(path)}
    assert found["a/order"] is Verdict.PROVED
    path.write_text(entry + 'sizes = ["1"]\n', encoding="utf-8")
    with pytest.raises(InputError, match="stands alone"):
        check_table(path)


@pytest.mark.parametrize("name", ["../t.csv", "/etc/passwd", "sub/t.csv", "none.csv"])
def test_a_csv_file_lies_beside_the_table(tmp_path: Path, name: str) -> None:
    path = tmp_path / "t.toml"
    path.write_text(f'[[table]]\nname = "a"\nkind = "runge-kutta"\norder = 3\ncsv = "{name}"\n')
    with pytest.raises(InputError):
        check_table(path)


@pytest.mark.parametrize(
    "numbers", ["1e400", "0." + "1" * 5000, "9" * 300 + ".5", "1.5e-399", "((((1))))", "1**9**9"]
)
def test_numbers_of_any_size_are_judged_or_refused(tmp_path: Path, numbers: str) -> None:
    path = tmp_path / "t.toml"
    path.write_text(GOOD.replace('"1", ', f'"{numbers}", '))
    if numbers == "((((1))))":
        assert check_table(path)[0].claim.verdict is Verdict.PROVED
    elif numbers == "1.5e-399":
        assert check_table(path)[0].claim.verdict is Verdict.REFUTED
    else:
        with pytest.raises(InputError, match=r"t\.toml:7"):
            check_table(path)
