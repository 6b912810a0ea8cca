"""Every reader of our files says in one line that a file is of another format or version."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.campaigns.kept_results import kept_results
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.keeper import KEPT, NOTHING, Keeper, seal, unseal
from verify.formats import check_format
from verify.proof.certificates import certificate_file as certificates
from verify.proof.certificates.certification import certify_for_every_h
from verify.proof.order_for_every_h import prove_for_every_h
from verify.reference.check.folder_check import check
from verify.reference.compare.published_data import load
from verify.reference.make.data_files import MANIFEST_FORMAT
from verify.reference.make.data_folder import PUBLISHED
from verify.reference.make.models import DATA_FORMAT
from verify.scenes.results import report as reports
from verify.scenes.results.report import Provenance, Report, read_report
from verify.studies.kinds.every import EveryTask

Reader = Callable[[Path], object]
REPORT = Report(
    title="none", claims=(), scenes=(), left_out=(),
    provenance=Provenance(command="", versions={}, machine="", seconds=1, kept=0, computed=0),
)  # fmt: skip


def manifest(path: Path) -> object:
    path.rename(path.parent / "manifest.json")
    return check(path.parent, share=0, seed=0)


def scene(path: Path) -> object:
    return load(path.parent, None).scene("duffing")


READERS: dict[str, tuple[str, Reader, Callable[[], str]]] = {
    "certificate": (
        certificates.FORMAT, certificates.check_file,
        lambda: json.dumps(certify_for_every_h(prove_for_every_h("lie2"))),
    ),
    "results.json": (reports.FORMAT, read_report, REPORT.model_dump_json),
    "data": (DATA_FORMAT, scene, (PUBLISHED / "duffing.json").read_text),
    "manifest": (MANIFEST_FORMAT, manifest, (PUBLISHED / "manifest.json").read_text),
}  # fmt: skip
readers = pytest.mark.parametrize(("own", "read", "written"), READERS.values(), ids=READERS)


@readers
def test_a_file_of_the_own_format_is_read(
    tmp_path: Path, own: str, read: Reader, written: Callable[[], str]
) -> None:
    path = tmp_path / "mine.json"
    path.write_text(written())
    assert json.loads(written())["format"] == own
    assert read(path)


MISSING = object()
OTHERS: dict[str, tuple[Callable[[str], Any], str]] = {
    "newer": (lambda own: own[:-1] + str(int(own[-1]) + 1), "which is newer"),
    "much-newer": (lambda own: own[:-1] + "9" * 5000, "which is newer"),
    "older": (lambda own: own[:-1] + "0", "which is older"),
    "no-number": (lambda own: own[:-1] + "one", "one'; this"),
    "no-version": (lambda own: own[:-2], "has the format"),
    "another-format": (lambda _: "areaproof poem 1", "'areaproof poem 1'"),
    "missing": (lambda _: MISSING, "names no format"),
    "null": (lambda _: None, "has the format None"),
    "a-number": (lambda _: 1, "has the format 1"),
    "a-list": (lambda own: [own], "has the format ['areaproof"),
}


@readers
@pytest.mark.parametrize(("other", "told"), OTHERS.values(), ids=OTHERS)
def test_a_file_of_another_format_is_one_line_and_nothing_else_of_it_is_read(
    tmp_path: Path, own: str, read: Reader, written: Callable[[], str],
    other: Callable[[str], Any], told: str,
) -> None:  # fmt: skip
    path, content = tmp_path / "mine.json", {"format": other(own), "title": 1, "name": []}
    if content["format"] is MISSING:
        del content["format"]
    path.write_text(json.dumps(content))
    with pytest.raises(InputError) as error:
        read(path)
    line = str(error.value)
    assert told in line
    assert f"this version reads {own!r}" in line
    assert "mine.json" in line or "manifest.json" in line
    assert "\n" not in line
    assert len(line) < 300


@pytest.mark.parametrize("content", ["[]", "1", "null", '"areaproof certificate 1"'])
def test_what_is_no_object_has_no_format(content: str) -> None:
    with pytest.raises(InputError, match="is no JSON object, but"):
        check_format(json.loads(content), "areaproof certificate 1", "mine.json")


def test_a_report_of_this_format_that_is_none_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "results.json").write_text(json.dumps({"format": reports.FORMAT}))
    with pytest.raises(InputError, match="is no report: title: Field required"):
        read_report(tmp_path / "results.json")
    with pytest.raises(InputError, match="No such file"):
        read_report(tmp_path / "none.json")


# -- what is kept: another version is not believed, and not worth a line ---------------------------

CHANGES: dict[str, Callable[[str], str]] = {
    "newer": lambda text: text.replace("kept result 2", "kept result 3"),
    "older": lambda text: text.replace("kept result 2", "kept result 1"),
    "another": lambda text: text.replace("kept result", "checkpoint"),
    "no-format": lambda text: text.replace('"format": "areaproof kept result 2", ', ""),
    "bare": lambda text: text.partition("\n")[2].removesuffix("}\n"),
    "one-digit": lambda text: text.replace('"order": 3', '"order": 4'),
    "no-digest": lambda text: text.replace('"sha256"', '"sha"'),
    "more": lambda text: text + "\n",
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_a_kept_result_of_another_version_or_content_is_none(
    tmp_path: Path, change: Callable[[str], str]
) -> None:
    store, task = Store(tmp_path), EveryTask(scheme="lie2")
    result = task.compute(NOTHING)
    store.put(task.key, result)
    assert store.get(task.key, task) == result
    (path,) = tmp_path.iterdir()
    text = path.read_text()
    assert json.loads(text)["format"] == KEPT
    path.write_text(change(text))
    assert path.read_text() != text
    assert store.get(task.key, task) is None
    assert store.taken == 1


@pytest.mark.parametrize(
    ("old", "new"),
    [("checkpoint 2", "checkpoint 3"), ("checkpoint 2", "kept result 2"), (": 5", ": 6")],
)
def test_a_checkpoint_of_another_version_or_content_is_none(
    tmp_path: Path, old: str, new: str
) -> None:
    keeper = Keeper(tmp_path, "run")
    keeper.save("plain", {"done": 5})
    assert keeper.load("plain") == {"done": 5}
    (path,) = tmp_path.iterdir()
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    assert keeper.load("plain") is None


def test_what_was_sealed_is_told_by_its_format() -> None:
    assert unseal(KEPT, "7f", seal(KEPT, "7f", "{}")) == "{}"
    assert unseal("areaproof poem 1", "7f", seal(KEPT, "7f", "{}")) is None
    assert unseal(KEPT, "8a", seal(KEPT, "7f", "{}")) is None
    assert unseal(KEPT, "7f", "") is None


def test_of_a_sample_of_the_campaigns_damages_all_are_noticed() -> None:
    assert kept_results(60, seed=3) == []


@pytest.mark.parametrize("kind", READERS)
def test_a_key_that_stands_twice_is_refused_by_every_reader(kind: str, tmp_path: Path) -> None:
    """The last one counts for Python, and the first one for others."""
    _, read, text = READERS[kind]
    path = tmp_path / "duffing.json"
    first = text().lstrip().removeprefix("{")
    path.write_text('{"title": 1, "title": 2, ' + first)
    with pytest.raises(InputError, match="a key stands twice"):
        read(path)


def test_a_key_of_a_certificate_that_stands_twice_within_it_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "twice.json"
    path.write_text(f'{{"format": "{certificates.FORMAT}", "witness": {{"p": "1", "p": "2"}}}}')
    with pytest.raises(InputError, match="a key stands twice"):
        certificates.check_file(path)
