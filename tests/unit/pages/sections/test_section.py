"""Sections are found by themselves, and what one carries is asked of it alone."""

from pathlib import Path

import pytest

from verify.discovery import Catalogue
from verify.pages.page import TEMPLATES
from verify.pages.sections import page, scene, scheme
from verify.pages.sections.section import SectionPlace, sections, select_sections, terms

_PLANTED = """
from markupsafe import Markup
from verify.pages.sections.section import ReportSection

SECTION = ReportSection(order={order}, title="T", anchor="a", view=lambda given: given or None,
                  terms=lambda views: {{"{order}": Markup("it")}})
"""


@pytest.mark.parametrize("level", [page, scene, scheme])
def test_every_section_has_its_template_and_its_own_place(level: object) -> None:
    found = sections(level.FILES)  # type: ignore[attr-defined]
    assert found
    assert all((TEMPLATES / template).is_file() for template, _ in found)
    orders = [section.order for _, section in found]
    assert orders == sorted(set(orders))


def test_a_file_is_a_section(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "planted_sections"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "one_file.py").write_text(_PLANTED.format(order=2))
    (folder / "another.py").write_text(_PLANTED.format(order=1))
    monkeypatch.syspath_prepend(tmp_path)
    files = Catalogue("planted_sections", [str(folder)])
    found = select_sections(files, SectionPlace("mine", "Mine"), "view")
    assert [each.template for each in found] == [
        "planted_sections/another.html",
        "planted_sections/one_file.html",
    ]
    assert (found[0].anchor, found[0].name) == ("a-of-mine", "T, Mine")
    assert [entry.anchor for each in found for entry in each.entries] == ["a-of-mine"] * 2
    assert list(terms(found)) == ["1", "2"]
    assert select_sections(files, SectionPlace("mine", "Mine"), "") == (), (
        "what has nothing to show is left out"
    )
