"""The erratum's tables: as they come out, each with its program beside it."""

import re
from fractions import Fraction
from pathlib import Path

from tests.helpers.constructed.papers import (
    SIZES,
    STARTS,
    P,
    R,
    U,
    each_category,
    paper,
    reading,
    repair,
    table,
)
from tests.helpers.pages.read_errata import MARKDOWN, tables, written
from verify.claims.table_script import table_script
from verify.scenes.scene import scene_from


def test_a_refuted_table_stands_as_it_comes_out_with_as_many_cells_in_each_row(
    tmp_path: Path,
) -> None:
    text = written(each_category(), tmp_path)["errata.md"]
    assert "\n## Table G, as it should read\n" in text
    ((head, *rows),) = tables(text)
    assert head == ["", *(f"h = {h}" for h in SIZES)]
    assert (len(rows), {len(row) for row in rows}) == (5, {7})
    assert [row[0] for row in rows] == [f"q₀ = {q}, p₀ = 0" for q in STARTS]
    assert rows[3][1:] == [f"−13.{n}071" for n in range(6)]
    lines = [line.strip() for line in text.splitlines() if line.startswith("|")]
    assert {len(re.findall(r"(?<!\\)\|", line)) for line in lines} == {8}
    assert "-9.0" not in text, "what is printed there now"


def test_in_latex_the_table_has_a_column_for_each_step_size(tmp_path: Path) -> None:
    text = written(each_category(), tmp_path)["errata.tex"]
    (columns, body) = re.findall(r"\\begin\{tabular\}\{(.*?)\}\n(.*?)\\end\{tabular\}", text, re.S)[
        0
    ]
    assert columns == "lrrrrrr"
    head, *rows = [line for line in body.splitlines() if "&" in line]
    assert [cell.strip() for cell in head.removesuffix(r"\\").split("&")] == [
        "$h$ =", *(f"${h}$" for h in SIZES),
    ]  # fmt: skip
    assert [row.count("&") for row in rows] == [6] * 5
    assert rows[3].endswith(" & ".join(f"$-13.{n}071$" for n in range(6)) + r" \\")


def test_where_each_start_has_a_printed_row_only_the_computed_ones_stand(tmp_path: Path) -> None:
    details = (
        ("initial value", "h = 0.1"), ("printed, q₀ = 1", "-1.5"), ("q₀ = 1", "-2.5"),
        ("printed, q₀ = 2", "-3.5"), ("q₀ = 2", "-4.5"),
    )  # fmt: skip
    text = written(paper(table("A", details=details)), tmp_path)["errata.md"]
    assert tables(text) == [[["", "h = 0.1"], ["q₀ = 1", "−2.5"], ["q₀ = 2", "−4.5"]]]


def test_a_table_that_holds_in_a_reading_or_is_ours_is_not_repaired(tmp_path: Path) -> None:
    claims = (
        table("A"), reading("A", P, id="A-otherwise"), table("", id="ours"),
        table("B", verdict=U), reading("C", R), repair("C"),
    )  # fmt: skip
    files = written(paper(*claims), tmp_path)
    assert [*files] == ["errata.tex", "errata.md", "editor.html"]
    assert tables(files["errata.md"]) == []


def test_two_readings_of_a_table_are_one_table(tmp_path: Path) -> None:
    files = written(paper(table("A"), table("A", id="A-otherwise")), tmp_path)
    assert len(tables(files["errata.md"])) == 1


def test_each_table_has_its_program_under_its_name_and_there_is_no_other_file(
    tmp_path: Path,
) -> None:
    claims = (
        table("Table 1", reproduction="print(1)\n"), table("table-1", reproduction="print(2)\n"),
        table("../Ä/x", reproduction="print(3)\n"), table("none", reproduction=""),
    )  # fmt: skip
    files = written(paper(*claims), tmp_path)
    programs = {name: files.pop(name) for name in [*files] if name.endswith(".py")}
    assert programs == {
        "table-1.py": "print(1)\n", "table-1-2.py": "print(2)\n", "x.py": "print(3)\n",
    }  # fmt: skip
    assert [*files] == ["errata.tex", "errata.md", "editor.html"]
    assert re.findall(r"\\texttt\{(.*?)\}", files["errata.tex"]) == [*programs]
    assert re.findall("^`(.*?)`, plain Python", files["errata.md"], re.M) == [*programs]
    fences = [token for token in MARKDOWN.parse(files["errata.md"]) if token.type == "fence"]
    assert [(fence.info, fence.content) for fence in fences] == [
        ("python", program) for program in programs.values()
    ]


def test_without_a_refuted_table_the_editor_is_told_of_none(tmp_path: Path) -> None:
    page = written(paper(reading("A", R), repair("A", effect="conclusion")), tmp_path)
    assert "tables" not in page["editor.html"]


def test_the_program_of_a_scheme_in_several_lines_is_python() -> None:
    """Its first line is a comment with the scheme, whose text is the user's."""
    fields = {"name": "x", "hamiltonian": "p**2/2 - cos(q)", "schemes": ["lie2"]}
    hamiltonian = scene_from(fields, "x.toml").exact_hamiltonian()
    scheme = "p_next = p - h*sin(q);\nq_next = q + h*p"
    starts, sizes = [(Fraction(1), Fraction(0))], [(Fraction(1, 10), 10)]
    program = table_script(hamiltonian, scheme, "lg_mse", starts, sizes)
    first = (
        "# lg mse of p_next = p - h*sin(q); q_next = q + h*p for H = p**2/2 - cos(q), in doubles"
    )
    assert program.splitlines()[0] == first
    compile(program, "table.py", "exec")
