"""The theory that is shipped for Rocq: its files, its theorems, and what a text needs of them.

The files lie below `theory/`, and each imports those that it depends on. `coqc -Q theory
AreaPreservation` compiles them one by one; an exported file that stands alone contains the parts of
them that it needs as modules, and leaves out the rest. Statements that follow from a theorem refer
to it by a `ShippedTheorem`.

A file of the theory is a sequence of sentences; what they prove or define has a name. A sentence is
kept if its name is a word of something that is kept and may mean it, whatever it does mean there:
rather too much is kept than too little, and `coqc` has the last word. What works without its name,
such as notations, records and instances, is always kept; the declarations of a section are dropped
with the last sentence that they serve.
"""

import re
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from verify.files import write_atomically
from verify.prose import Formula, Prose, join_prose, prose

FOLDER = Path(__file__).parent / "theory"
LOGICAL = "AreaPreservation"  # by which coqc knows the folder
_THEORY_IMPORT = re.compile(rf"^From {LOGICAL} Require Import ([^.]*)\.\n", re.MULTILINE)
_LIBRARY_IMPORT = re.compile(r"^From Coq Require Import ([^.]*)\.\n", re.MULTILINE)
_THEOREM_NAME = re.compile(r"^\s*(?:Theorem|Lemma|Corollary)\s+(\w+)", re.MULTILINE)
_WORD = re.compile(r"[A-Za-z_][\w']*")
_END_OF_SENTENCE = re.compile(r"\.(?=\s)")
_END_OF_PROOF = re.compile(r"\b(?:Qed|Defined)\.(?=\s)")
_COMMENT = re.compile(r"\(\*|\*\)")
_DEFINED = re.compile(r"(?:Lemma|Theorem|Corollary|Definition|Fixpoint|Ltac)\s+([A-Za-z_][\w']*)")
_PROOF = re.compile(r"\s*Proof\b")
_IMPORT_SENTENCE = re.compile(r"(?:From \w+ Require )?Import\b")
_SECTION = re.compile(r"Section (\w+)\.")
_IN_FILE = re.compile(r"Local\b")
_IN_SECTION = re.compile(r"(?:Section|End|Context|Let|Notation|Add Ring|Local|Implicit Types)\b")


# -- files ----------------------------------------------------------------------------------------


@cache
def files() -> dict[str, Path]:
    """Return the files of the theory by their names, which are unique across folders."""
    return {path.stem: path for path in sorted(FOLDER.rglob("*.v"))}


@cache
def text_of(name: str) -> str:
    """Read the file of this name."""
    return files()[name].read_text(encoding="utf-8")


def imports_of(name: str) -> list[str]:
    """Return the names of the files that a file of the theory imports."""
    return _words(_THEORY_IMPORT, text_of(name))


def sort_by_imports(names: Iterable[str]) -> list[str]:
    """Return these files and all that they depend on, each after its imports."""
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
    """Format the line by which a file imports these from an installed theory."""
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
    """The theorem of this name in the file of the theory that is called `file`.

    Raises ValueError if that file states no such theorem, so no reference can outlive it.
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
    """Say that the theorems FILE.NAME prove it; ValueError if one is not stated."""
    # `ShippedTheorem` checks that the theory states the theorem.
    theorems = (Formula(str(ShippedTheorem(*name.split(".")))) for name in names)
    return prose("Rocq, ", join_prose(", ", theorems))


# -- the parts that a text needs ------------------------------------------------------------------


def format_modules(names: Iterable[str], user_text: str) -> str:
    """Format what `user_text` needs of these files, and of their imports, as modules.

    The text ends with the line that imports these modules.
    """
    names = list(names)
    ordered = sort_by_imports(names)
    # Libraries are imported once for all modules: each time takes a fifth of a second. Every file
    # says which scopes it means, and its own names are imported after theirs.
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

    `name`: the name that it proves or defines, if that is its only use; `section`: the name of its
    section; `serves`: whether it only serves other sentences of its file or section.
    """

    text: str
    words: frozenset[str]
    name: str | None
    section: str | None
    serves: bool


def select_needed(
    files: Mapping[str, str], below: Mapping[str, Iterable[str]], user_text: str
) -> dict[str, str]:
    """Return the parts of these files that `user_text` needs, without files that become empty.

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
    """Return the numbers of the parts that are kept."""
    numbers: set[int] = set()
    words = {file: set(user_words) for file, _ in parts}  # that may mean something of the file
    in_use: set[tuple[str, str | None]] = set()  # files, and sections in them

    def stays(file: str, part: Part) -> bool:
        if part.name is not None:
            return part.name in words[file]
        return not part.serves or (file, part.section) in in_use

    # A fixed point: each round keeps what the round before names, until nothing is added.
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
    """Split the file into parts, whose texts follow one another in it."""
    parts: list[Part] = []
    plain, begin, section = without_comments(text), 0, None
    for end in _ends(plain):
        sentence = plain[begin:end].strip()
        if section is None and (section_start := _SECTION.match(sentence)):
            section = section_start[1]
        parts.append(_part(text[begin:end], sentence, section))
        if sentence == f"End {section}.":
            section = None
        begin = end
    return (*parts, Part(text[begin:], frozenset(), None, None, serves=True))


def _part(text: str, sentence: str, section: str | None) -> Part:
    definition, imports = _DEFINED.match(sentence), _IMPORT_SENTENCE.match(sentence)
    serving = _IN_FILE if section is None else _IN_SECTION
    # The names of imported files are no use of what these files define.
    words = frozenset() if imports else words_of(sentence)
    serves = bool(imports or serving.match(sentence))
    return Part(text, words, definition[1] if definition else None, section, serves)


def _ends(plain: str) -> Iterator[int]:
    """Yield the ends of the sentences; a proof belongs to the sentence before it."""
    end = 0
    while sentence_end := _END_OF_SENTENCE.search(plain, end):
        end = sentence_end.end()
        if _PROOF.match(plain, end):
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
