"""One Rocq that reads text after text, each as if it were the first.

To load the library takes `coqc` longer than to check most texts. Here it is loaded once, and not
imported; what a text says it imports is imported for it, and taken back with all that it does.
"""

import re
import subprocess
from itertools import count
from pathlib import Path
from threading import Timer
from typing import Self

from tests.helpers.programs.compilers import needed
from tests.helpers.rocq.assumptions import without_comments
from tests.helpers.rocq.coqc import ENVIRONMENT, LONGEST, beside, options

_LIBRARY = "From Coq Require Reals ZArith QArith Qreals List Bool Lia Lra."
_TAKEN = "The command has succeeded and its effects have been reverted.\n"
_REFUSED = "The command has indeed failed with message:\n"
_ERROR = "Toplevel input, "
_PROMPT = re.compile(r"\n?Coq < ")
_NAMED = re.compile(
    r"^\s*(?:Local |Global )?"
    r"(?:Theorem|Corollary|Lemma|Definition|Fixpoint|Record|Instance) ([\w']+)",
    re.MULTILINE,
)
# What Rocq says of a text that has no meaning: no proof of ours that it looked at.
_MEANINGLESS = ("Syntax error", "Lexer", "was not found in", "Cannot find a", "Unable to locate")
_DEFINED = re.compile(r"^([\w']+) is defined$", re.MULTILINE)


class Session:
    """`coqtop`, with the theory that is compiled in a folder; `folder`: for what it reads."""

    def __init__(self, theory: Path, folder: Path) -> None:
        self._text = folder / "text.v"
        # Where Rocq writes at the end wherever we read.
        self._complaints = (folder / "complaints").open("a+", encoding="utf-8")
        self._process = subprocess.Popen(
            [needed("coqtop"), "-q", *options(beside(theory))],
            env=ENVIRONMENT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._complaints,
            text=True,
        )
        self._numbers = count()
        self._answer(_LIBRARY)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.communicate()
        self._complaints.close()

    def accepted(self, text: str, *, warned: bool = False) -> str:
        """What is printed of the text, which has to be taken, unless `warned` without a warning."""
        said, complaints = self._load("Succeed Load", text)
        assert said.endswith(_TAKEN), self._load("Fail Load", text)[0]  # which says why
        assert warned or not complaints, complaints
        return said.removesuffix(_TAKEN)

    def stops_at(self, text: str) -> str:
        """The theorem or definition of the text that is not taken, where all before it are."""
        said, complaints = self._load("Fail Load Verbose", text)
        defined, refused, why = said.rpartition(_REFUSED)
        assert refused, complaints
        assert not any(words in why for words in _MEANINGLESS), why
        return first_missing(text, defined)

    def _load(self, how: str, text: str) -> tuple[str, str]:
        self._text.write_text(text, encoding="utf-8")
        return self._answer(f'{how} "{self._text}".')

    def _answer(self, sentence: str) -> tuple[str, str]:
        """What is said until the next sentence is answered, and warnings and errors."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        mark, said = f"answer_{next(self._numbers)}", list[str]()
        before = self._complaints.seek(0, 2)
        # Each is answered on a stream of its own, and neither stream waits for the other.
        marks = f"Check {mark}.\nLocate {mark}."
        print(f"{sentence}\n{marks}", file=self._process.stdin, flush=True)
        late = Timer(LONGEST, self._process.kill)
        late.start()
        for line in self._process.stdout:
            if line == f"No object of basename {mark}\n":
                break
            said.append(line)
        complaints = ""
        while f"> Check {mark}." not in complaints and self._process.poll() is None:
            self._complaints.seek(before)
            complaints = self._complaints.read()
        late.cancel()
        assert self._process.poll() is None, "".join(said)
        complaints = complaints.partition(f"> Check {mark}.")[0].rpartition(_ERROR)[0]
        return "".join(said), _PROMPT.sub("", complaints).strip()


def first_missing(text: str, said: str) -> str:
    """The first that the text names, and that is not said to be defined."""
    told = iter(_DEFINED.findall(said))
    names = _NAMED.findall(without_comments(text))
    return next((name for name in names if name not in told), "nothing that it names")
