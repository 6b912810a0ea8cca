"""README.md and docs: what they tell to do is done, and what they print is what comes out."""

import re
from pathlib import Path

import pytest

from tests.helpers.pages.blocks import PAGES
from tests.helpers.pages.session import PageError, read_through

# What these define is looked at further, by a test that reads them through itself.
ELSEWHERE = {
    "docs/how-to/notebooks.md": "test_example.py",
    "docs/reference/results-json.md": "test_results_schema.py",
}


@pytest.mark.parametrize("name", sorted(set(PAGES) - set(ELSEWHERE)))
def test_what_a_page_prints_is_what_comes_out(name: str, tmp_path: Path) -> None:
    read_through(PAGES[name], tmp_path)


@pytest.mark.parametrize("name", ELSEWHERE)
def test_the_other_pages_are_read_through_elsewhere(name: str) -> None:
    test = Path(__file__).with_name(ELSEWHERE[name]).read_text(encoding="utf-8")
    assert re.search(rf'read_through\(\s*PAGES\["{re.escape(name)}"\]', test)


# -- a page that is wrong is seen -----------------------------------------------------------------

PAGE = """
Save this as `mine.toml`:

```toml
[defaults]
scheme = "lie2"
system = "duffing"
```

Append this to `mine.toml`:

```toml
[[claim]]
id = "order"
kind = "defect_order"
defect_order = 4
```

```console
$ verify check mine.toml \\
      --only order
REFUTED    order  ΔJ = (3*delta*p*q)·h^3 + O(h^4); at p = 7/17, q = 11/19, delta = 13/23 the \
coefficient is [0.404226679230 +/- 4.45e-14], where delta ≠ 0
1 claim: 1 REFUTED
$ echo $?
1
$ cat mine.toml
[defaults]
…
defect_order = 4
```

```python
from verify.schemes import get
```

```pycon
>>> get("lie2").order
2
```

```sh
python3 -m venv .venv && .venv/bin/verify report paper -o paper-report   # takes minutes
```
"""
WRONG = {
    "a digit": ("404226679230", "404226679231"),
    "a line too few": ("1 claim: 1 REFUTED\n", ""),
    "a line too many": ("1 claim: 1 REFUTED\n", "1 claim: 1 REFUTED\nnothing else\n"),
    "a status that is not told": ("$ echo $?\n1\n", ""),
    "another status": ("$ echo $?\n1\n", "$ echo $?\n0\n"),
    "a file that nobody told to save": ("Save this as", "This is"),
    "what is appended, saved": ("Append this to", "Save this as"),
    "what is saved, appended": ("Save this as", "Append this to"),
    "an option that is not there": ("paper -o", "paper --output-folder"),
    "a command that is not there": ("verify report", "verify reprot"),
    "a program that is not known": ("python3 -m", "pyhton3 -m"),
    "Python that fails": ("import get", "import got"),
    "another value": (".order\n2", ".order\n3"),
    "lines left out where others stand": ("…\ndefect_order = 4", "…\ndefect_order = 5"),
    "a block of no kind": ("```sh", "```"),
}


def test_a_page_that_is_right_is_read_through(tmp_path: Path) -> None:
    session = read_through(PAGE, tmp_path)
    assert session.ran == 3
    assert session.names["get"]


@pytest.mark.parametrize("what", WRONG)
def test_a_page_that_is_wrong_is_seen(what: str, tmp_path: Path) -> None:
    old, new = WRONG[what]
    assert PAGE.count(old) == 1
    with pytest.raises(PageError):
        read_through(PAGE.replace(old, new), tmp_path)


BY_HAND = """
<!-- run by hand: 2026-11-24, 6 min -->
```console
$ verify prove --system pendulum --scheme lie2
REFUTED
```

<!-- run by hand: 2026-11-24, 6 min -->
```sh
echo done > made.txt && verify prove --system pendulum --scheme lie2 > proof.txt
```
"""


def test_what_a_person_runs_is_only_parsed(tmp_path: Path) -> None:
    page = BY_HAND.replace("echo done > made.txt && ", "")
    assert read_through(page, tmp_path).ran == 0
    assert not (tmp_path / "proof.txt").exists()
    other = tmp_path / "other"
    other.mkdir()
    with pytest.raises(PageError, match="No such option"):
        read_through(page.replace("--scheme", "--skeme"), other)


def test_what_a_person_runs_is_compared_where_one_does(tmp_path: Path) -> None:
    first, second = tmp_path / "first", tmp_path / "second"
    first.mkdir()
    second.mkdir()
    with pytest.raises(PageError, match="line 3"):
        read_through(BY_HAND, first, by_hand=True)
    assert read_through(BY_HAND.replace("REFUTED", "…"), second, by_hand=True).ran == 1
    assert (second / "made.txt").read_text() == "done\n"
    assert (second / "proof.txt").read_text().startswith("PROVED")
