"""Fuzzed inputs of all that is read, in this process: only documented errors, and no hanging.

    python -m tests.campaigns.readers --count 300000 --seed 1

A valid input of each sort has characters or tokens changed, doubled, dropped, or put in from
another one; a reader gives a value or raises InputError, whose message is one printable line.
"""

import argparse
import json
import random
import re
import signal
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

from tests.paths import ROOT
from verify.arithmetic.exact import rational
from verify.claims.claims_file import load_claims
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tables.table_file import check_table
from verify.proof.certificates.certificate_file import check_file
from verify.proof.certificates.certification import certify_for_every_h
from verify.proof.order_for_every_h import prove_for_every_h
from verify.reference.compare.published_data import load
from verify.reference.make.data_folder import PUBLISHED
from verify.reference.make.file_contents import open_table, parquet_bytes, parquet_rows
from verify.scenes.results.report import Provenance, Report, read_report
from verify.scenes.scene import load_scene
from verify.scenes.shapes.user_outline import svg_path
from verify.schemes import get

_SHOWN = 50  # failures
SLOWEST = 10  # seconds for one input
TOKENS = (
    "p", "q", "h", "sin(", "exp(", "sqrt(", "log(", "(", ")", "**", "*", "/", "+", "-", "0", "-1",
    "1e-1000", "1e999999", "9" * 400, "1/0", "nan", "inf", "=", ";", "[", "]", "{", "}", '"', "'",
    "\n", ",", "\x00", "\x1b[31m", "é", "𝑝", "٣", "__import__('os')", "lambda", "p_next", "#",
    "...", "\\", "::", "true", "null", "1_000", "0x10", "[[claim]]",
    "[[table]]", "×", "½", "√", "−",
)  # fmt: skip
FORMULAS = (
    "p**2/2 + q**2/2 + delta*q**4/4", "p**2/2 - cos(q)", "exp(-q)*p + 1/(1 + q**2)",
    "sqrt(1 + p**2) - log(2 + q**2)", "tanh(q)*p**2 + pi*q", "(p + q)**3/7 - 0.001*q",
)  # fmt: skip
NUMBERS = ("0.001", "7/3", "-1e-9", "1e300", "12", "-0.5", "1/1000000007")
SCHEMES = ("lie2", "p_next = p - h*q; q_next = q + h*p_next", "gauss4", "stormer-verlet",
           "kick 1/2; drift 1; kick 1/2")  # fmt: skip
PATHS = ("M 0 0 L 1 0 L 1 1 Z", "M0,0c1,2 3,4 5,6s1 1 2 2z", "m 1 1 a 1 2 30 0 1 3 3 h 4 v -2 z")
TABLE = "step,q,p,delta_j\n0,1.5,0,1e-9\n1,1.4,0.1,2e-9\n# a comment\n2,1.3,0.2,3e-9\n"

Reader = Callable[[Path], object]  # of a file that holds the text


def _of_text(read: Callable[[str], object]) -> Reader:
    return lambda path: read(path.read_text(encoding="utf-8", errors="replace"))


def _table(path: Path) -> int:
    with open_table(path) as lines:
        return sum(1 for _ in lines)


def _reference(path: Path) -> int:
    """A folder of reference data with one file, which holds this."""
    folder = path.parent / "data"
    folder.mkdir(exist_ok=True)
    (folder / "mine.json").write_bytes(path.read_bytes())
    return len(list(load(folder, None).runs()))


def _parquet(path: Path) -> object:
    """A table of reference data, whose bytes are characters here."""
    return parquet_rows(path.read_text("utf-8", "replace").encode("latin-1", "replace"), path.name)


def _claims(path: Path) -> object:
    """A claims file beside the scenes that its claims name."""
    for scene in (ROOT / "reports/paper").glob("*.toml"):
        beside = path.parent / scene.name
        if scene.name != "claims.toml" and not beside.exists():
            beside.symlink_to(scene)
    return load_claims(path)


def _coefficients() -> tuple[str, ...]:
    """Files of one printed table each."""
    right = (ROOT / "tests/helpers/tables/right.toml").read_text("utf-8").split("[[table]]")[1:]
    printed = (ROOT / "reports/audits/literature.toml").read_text("utf-8").split("[[table]]")[1:8]
    return tuple(f"[[table]]{each}" for each in (*right, *printed))


@cache
def sorts() -> dict[str, tuple[Reader, tuple[str, ...]]]:
    """Each sort of input: who reads it, and valid ones."""
    scenes = tuple(p.read_text("utf-8") for p in sorted((ROOT / "reference/scenes").glob("*.toml")))
    papers = tuple((ROOT / "reports/paper" / f"{n}.toml").read_text("utf-8") for n in ("duffing",))
    claims = (ROOT / "reports/paper/claims.toml").read_text("utf-8").split("[[claim]]")
    short = tuple(claims[0] + "[[claim]]" + each for each in claims[1:8])
    made = tuple(
        json.dumps(certify_for_every_h(prove_for_every_h(n))) for n in ("lie2", "implicit-midpoint")
    )
    told = Provenance(command="", versions={}, machine="", seconds=1, kept=0, computed=0)
    report = Report(title="a", claims=(), scenes=(), left_out=(), provenance=told)
    data = (PUBLISHED / "extreme-zero.json").read_text("utf-8")
    return {
        "formula": (_of_text(Hamiltonian.parse), FORMULAS),
        "number": (_of_text(rational), NUMBERS),
        "scheme": (_of_text(get), SCHEMES),
        "path": (_of_text(svg_path), PATHS),
        "scene": (load_scene, scenes + papers),
        "claims": (_claims, short),
        "certificate": (check_file, made),
        "table": (_table, (TABLE,)),
        "coefficients": (check_table, _coefficients()),
        "report": (read_report, (report.model_dump_json(),)),
        "reference": (_reference, (data,)),
        "parquet": (_parquet, (parquet_bytes([("t", "q"), ("1", "2")]).decode("latin-1"),)),
    }


def fuzzed(text: str, others: tuple[str, ...], rng: random.Random) -> str:
    """The text with one to five changes of characters or tokens."""
    for _ in range(rng.choice((1, 1, 2, 3, 5))):
        parts = [part for part in re.split(r"(\w+|\s+|[^\w\s])", text) if part]
        if not parts:
            return rng.choice(TOKENS)
        at = rng.randrange(len(parts))
        match rng.randrange(7):
            case 0:
                parts[at] = rng.choice(TOKENS)
            case 1:
                parts.insert(at, rng.choice(TOKENS))
            case 2:
                del parts[at : at + rng.choice((1, 1, 2, 10))]
            case 3:
                parts[at:at] = parts[at : at + rng.choice((1, 3, 30))]
            case 4:
                other = rng.choice(others)
                start = rng.randrange(len(other))
                parts.insert(at, other[start : start + rng.choice((1, 10, 100))])
            case 5:
                parts[at] = parts[at][::-1]
            case _:
                parts[at] = chr(rng.choice((rng.randrange(128), rng.randrange(0x2FFF)))) + parts[at]
        text = "".join(parts)
    return text


@contextmanager
def at_most(seconds: int) -> Iterator[None]:
    """TimeoutError where it takes longer."""

    def late(*_: object) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def campaign(count: int, seed: int) -> tuple[Counter[str], list[str]]:
    """How often each sort was read or refused, and what went wrong."""
    rng = random.Random(seed)  # noqa: S311 - no secret
    answers: Counter[str] = Counter()
    wrong: list[str] = []
    every: tuple[str, ...] = tuple(text for _, texts in sorts().values() for text in texts)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "input"
        for k in range(count):
            sort = rng.choice(list(sorts()))
            read, texts = sorts()[sort]
            text = fuzzed(rng.choice(texts), every, rng)
            path.write_text(text, encoding="utf-8", errors="surrogatepass")
            begun = time.perf_counter()
            told = _told(read, path)
            answers[f"{sort} {told or 'read'}" if told in ("", "refused") else "WRONG"] += 1
            if told not in ("", "refused"):
                seconds = time.perf_counter() - begun
                wrong.append(f"{k} {sort}: {told} after {seconds:.1f} s: {text[:300]!a}")
    return answers, wrong


def _told(read: Callable[[Path], Any], path: Path) -> str:
    """Empty where it is read, "refused" where that is as documented, else what happened."""
    try:
        with at_most(SLOWEST):
            read(path)
    except InputError as error:
        return "refused" if str(error).isprintable() else f"unprintable {str(error)!a}"
    except Exception as error:  # all others are what is looked for
        return f"{type(error).__name__}: {error}"
    return ""


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=300_000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    answers, wrong = campaign(given.count, given.seed)
    print(dict(sorted(answers.items())))
    print(f"{given.count} inputs, {len(wrong)} failures")
    print(*wrong[:_SHOWN], sep="\n")
    raise SystemExit(bool(wrong))


if __name__ == "__main__":
    main()
