"""The theory that is shipped for Rocq: its files, its theorems, and the parts that a text needs.

The files lie below `theory/`, and each imports those that it depends on. `coqc -Q theory
AreaPreservation` compiles them one by one; an exported file that stands alone contains the parts of
them that it needs, as modules. A statement in this project that follows from a theorem refers to it
by a `ShippedTheorem`.

A file of the theory is a sequence of sentences, most of which prove or define a name. A sentence is
kept if its name occurs as a word in a kept sentence that may refer to it, whatever the word means
there. So too many sentences may be kept rather than too few, and `coqc` decides in the end.
Sentences that take effect without their name, such as notations, records and instances, are always
kept. The declarations of a section are dropped with the last sentence that they serve.
"""

import re
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from verify.files import write_atomically
from verify.prose import Formula, Prose, join_prose, prose

FOLDER = Path(__file__).parent / "theory"
LOGICAL = "AreaPreservation"  # the logical name of the folder in coqc
_THEORY_IMPORT = re.compile(rf"^From {LOGICAL} Require Import ([^.]*)\.\n", re.MULTILINE)
_LIBRARY_IMPORT = re.compile(r"^From Coq Require Import ([^.]*)\.\n", re.MULTILINE)
_THEOREM_NAME = re.compile(r"^\s*(?:Theorem|Lemma|Corollary)\s+(\w+)", re.MULTILINE)
_WORD = re.compile(r"[A-Za-z_][\w']*")
_END_OF_SENTENCE = re.compile(r"\.(?=\s)")
_END_OF_PROOF = re.compile(r"\b(?:Qed|Defined)\.(?=\s)")
_COMMENT = re.compile(r"\(\*|\*\)")
_DEFINING = re.compile(r"(?:Lemma|Theorem|Corollary|Definition|Fixpoint|Ltac)\s+([A-Za-z_][\w']*)")
_PROOF_START = re.compile(r"\s*Proof\b")
_IMPORT_SENTENCE = re.compile(r"(?:From \w+ Require )?Import\b")
_SECTION_START = re.compile(r"Section (\w+)\.")
_FILE_LOCAL = re.compile(r"Local\b")
_SECTIONAL = re.compile(r"(?:Section|End|Context|Let|Notation|Add Ring|Local|Implicit Types)\b")


# -- files ----------------------------------------------------------------------------------------


@cache
def files() -> dict[str, Path]:
    """Return the files of the theory by their names, which are unique across folders."""
    return {path.stem: path for path in sorted(FOLDER.rglob("*.v"))}


@cache
def text_of(name: str) -> str:
    """Return the text of the file of this name."""
    return files()[name].read_text(encoding="utf-8")


def imports_of(name: str) -> list[str]:
    """Return the names of the files that a file of the theory imports."""
    return _words(_THEORY_IMPORT, text_of(name))


def sort_by_imports(names: Iterable[str]) -> list[str]:
    """Return these files and all that they import, each after its imports."""
    ordered: dict[str, None] = {}

    def add(name: str) -> None:
        if name not in ordered:
            for below in imports_of(name):
                add(below)
            ordered[name] = None

    for name in names:
        add(name)
    return list(ordered)


def import_line(names: Iterable[str]) -> str:
    """Format the line that imports these files from an installed theory."""
    return f"From {LOGICAL} Require Import {' '.join(names)}.\n"


def install(folder: Path) -> list[Path]:
    """Write the theory to the folder, with the project file that `coq_makefile` takes.

    Raises InputError if a file cannot be written.
    """
    paths = []
    for name in sort_by_imports(files()):
        path = folder / files()[name].relative_to(FOLDER)
        write_atomically(path, text_of(name))
        paths.append(path)
    listed = "".join(f"{path.relative_to(folder).as_posix()}\n" for path in paths)
    write_atomically(folder / "_CoqProject", f"-Q . {LOGICAL}\n{listed}")
    return paths


# -- theorems -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class ShippedTheorem:
    """The theorem `name` in the file `file` of the theory.

    Raises ValueError if that file states no such theorem, so that no reference can be outdated.
    """

    file: str
    name: str

    def __post_init__(self) -> None:
        if self.name not in _stated_theorems(self.file):
            raise ValueError(f"theorem={self}: the theory states none of this name")

    def __str__(self) -> str:
        return f"{self.file}.{self.name}"


@cache
def _stated_theorems(file: str) -> frozenset[str]:
    return frozenset(_THEOREM_NAME.findall(text_of(file)) if file in files() else ())


def cite_theorems(names: Iterable[str]) -> Prose:
    """Return a citation of the theorems FILE.NAME; ValueError if one is not stated."""
    # `ShippedTheorem` raises the ValueError.
    theorems = (Formula(str(ShippedTheorem(*name.split(".")))) for name in names)
    return prose("Rocq, ", join_prose(", ", theorems))


# -- the parts that a text needs ------------------------------------------------------------------


def format_modules(names: Iterable[str], user_text: str) -> str:
    """Format as modules the parts of these files and their imports that `user_text` needs.

    The text ends with the line that imports these modules.
    """
    names = list(names)
    ordered = sort_by_imports(names)
    # Libraries are imported once for all modules, as each import takes a fifth of a second. That
    # changes nothing: every file names its scopes, and imports the theory's names after theirs.
    library = sorted({word for name in ordered for word in _words(_LIBRARY_IMPORT, text_of(name))})
    below = {name: sort_by_imports([name]) for name in ordered}
    files = select_needed({name: text_of(name) for name in ordered}, below, user_text)
    modules = [
        f"Module {name}.\n{_inside(text, files)}End {name}.\n" for name, text in files.items()
    ]
    loaded = f"From Coq Require Import {' '.join(library)}.\n"
    return "\n".join([loaded, *modules, _format_import(names, files)])


def _words(pattern: re.Pattern[str], text: str) -> list[str]:
    return [word for listed in pattern.findall(text) for word in listed.split()]


def _inside(text: str, files: Container[str]) -> str:
    """Return a file's text for use in a module, its imports restricted to these files."""
    local_text = _THEORY_IMPORT.sub(lambda match: _format_import(match[1].split(), files), text)
    return _LIBRARY_IMPORT.sub("", local_text)


def _format_import(names: Iterable[str], files: Container[str]) -> str:
    remaining = [name for name in names if name in files]
    return f"Import {' '.join(remaining)}.\n" if remaining else ""


@dataclass(frozen=True)
class Part:
    """A sentence with its proof, and the comment before it.

    `name`: the name that it proves or defines, if the sentence is needed only for that. `section`:
    the name of its section. `serves`: True if it only serves other sentences of its file or
    section.
    """

    text: str
    words: frozenset[str]
    name: str | None
    section: str | None
    serves: bool


def select_needed(
    files: Mapping[str, str], below: Mapping[str, Iterable[str]], user_text: str
) -> dict[str, str]:
    """Return the parts of these files that `user_text` needs; empty files are left out.

    `below`: for each file, the files whose names it may use, itself among them.
    """
    parts = [(file, part) for file, text in files.items() for part in parts_of(text)]
    kept_parts = [
        parts[k]
        for k in sorted(_numbers_of_kept(parts, below, words_of(without_comments(user_text))))
    ]
    words = words_of(user_text).union(*(part.words for _, part in kept_parts))
    stays = {file for file, part in kept_parts if not part.serves} | (set(files) & words)
    return {
        file: "".join(part.text for owner, part in kept_parts if owner == file)
        for file in files
        if file in stays
    }


def _numbers_of_kept(
    parts: Sequence[tuple[str, Part]], below: Mapping[str, Iterable[str]], user_words: Iterable[str]
) -> set[int]:
    """Return the indices of the parts that are kept."""
    numbers: set[int] = set()
    words = {file: set(user_words) for file, _ in parts}  # words that may refer to the file's names
    in_use: set[tuple[str, str | None]] = set()  # (file, section) with kept parts; None: the file

    def stays(file: str, part: Part) -> bool:
        if part.name is not None:
            return part.name in words[file]
        return not part.serves or (file, part.section) in in_use

    # Each round keeps the parts that the round before refers to, until nothing is added.
    while added := {
        k for k, (file, part) in enumerate(parts) if k not in numbers and stays(file, part)
    }:
        numbers |= added
        for file, part in map(parts.__getitem__, added):
            for file_below in below[file]:
                words[file_below] |= part.words
            if not part.serves:
                in_use |= {(file, None), (file, part.section)}
    return numbers


@cache
def parts_of(text: str) -> tuple[Part, ...]:
    """Split a file's text into its consecutive parts."""
    parts: list[Part] = []
    plain, begin, section = without_comments(text), 0, None
    for end in _ends(plain):
        sentence = plain[begin:end].strip()
        if section is None and (section_start := _SECTION_START.match(sentence)):
            section = section_start[1]
        parts.append(_part(text[begin:end], sentence, section))
        if sentence == f"End {section}.":
            section = None
        begin = end
    return (*parts, Part(text[begin:], frozenset(), None, None, serves=True))


def _part(text: str, sentence: str, section: str | None) -> Part:
    definition, imports = _DEFINING.match(sentence), _IMPORT_SENTENCE.match(sentence)
    serving = _FILE_LOCAL if section is None else _SECTIONAL
    # An import names files; that is no use of the names that these define.
    words = frozenset() if imports else words_of(sentence)
    serves = bool(imports or serving.match(sentence))
    return Part(text, words, definition[1] if definition else None, section, serves)


def _ends(plain: str) -> Iterator[int]:
    """Yield the ends of the sentences; a proof belongs to the sentence before it."""
    end = 0
    while sentence_end := _END_OF_SENTENCE.search(plain, end):
        end = sentence_end.end()
        if _PROOF_START.match(plain, end):
            proof = _END_OF_PROOF.search(plain, end)
            end = proof.end() if proof else len(plain)
        yield end


def words_of(plain: str) -> frozenset[str]:
    """Return the words of a text without comments, any of which may be a name."""
    return frozenset(_WORD.findall(plain))


def without_comments(text: str) -> str:
    """Replace the comments of the text, which may be nested, with blanks."""
    pieces, depth, begin = [], 0, 0
    for bracket in _COMMENT.finditer(text):
        opens = bracket[0] == "(*"
        depth += 1 if opens else -1
        if opens and depth == 1:
            pieces.append(text[begin : bracket.start()])
            begin = bracket.start()
        elif depth == 0:
            pieces.append(re.sub(r"[^\n]", " ", text[begin : bracket.end()]))
            begin = bracket.end()
    return "".join([*pieces, text[begin:]])
