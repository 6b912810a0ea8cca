"""The theory: files for Rocq below `theory/`, each of which imports those that it stands on.

`coqc -Q theory AreaPreservation` compiles them one by one; a file that is to stand alone holds
what it needs of them as modules.

What a file that stands alone needs of the theory: what nothing in it names is left out.

A file of the theory is a row of sentences; what they prove or define has a name. It stays where its
name is a word of something that stays and may mean it, whatever it does mean there: rather too much
stays than too little, and `coqc` has the last word. What works without being named, such
as notations, records and instances, always stays; what a section declares for itself goes with the
last that it is declared for.
"""

import re
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from verify.files import write_atomically

_WORD = re.compile(r"[A-Za-z_][\w']*")
_END_OF_SENTENCE = re.compile(r"\.(?=\s)")
_END_OF_PROOF = re.compile(r"\b(?:Qed|Defined)\.(?=\s)")
_COMMENT = re.compile(r"\(\*|\*\)")
_NAMED = re.compile(r"(?:Lemma|Theorem|Corollary|Definition|Fixpoint|Ltac)\s+([A-Za-z_][\w']*)")
_PROOF = re.compile(r"\s*Proof\b")
_IMPORTS = re.compile(r"(?:From \w+ Require )?Import\b")
_SECTION = re.compile(r"Section (\w+)\.")
_OF_A_FILE = re.compile(r"Local\b")
_OF_A_SECTION = re.compile(r"(?:Section|End|Context|Let|Notation|Add Ring|Local|Implicit Types)\b")


@dataclass(frozen=True)
class Part:
    """A sentence with its proof, and the comment before it.

    `name`: of what it proves or defines, by which alone it is of use; `section`: the name of the
    one it stands in; `serves`: whether it is there for what else is in the file, or in its section.
    """

    text: str
    words: frozenset[str]
    name: str | None
    section: str | None
    serves: bool


def needed(files: Mapping[str, str], below: Mapping[str, Iterable[str]], by: str) -> dict[str, str]:
    """What the text `by` needs of these files, without those of which nothing is left.

    `below`: of each file those that it may name something of, itself among them.
    """
    parts = [(file, part) for file, text in files.items() for part in parts_of(text)]
    kept = [parts[k] for k in sorted(_kept(parts, below, words_of(without_comments(by))))]
    words = words_of(by).union(*(part.words for _, part in kept))
    stays = {file for file, part in kept if not part.serves} | (set(files) & words)
    return {
        file: "".join(part.text for of, part in kept if of == file)
        for file in files
        if file in stays
    }


def _kept(
    parts: Sequence[tuple[str, Part]], below: Mapping[str, Iterable[str]], by: Iterable[str]
) -> set[int]:
    """Those that stay, by their numbers."""
    kept: set[int] = set()
    named = {file: set(by) for file, _ in parts}  # words that may mean something of the file
    in_use: set[tuple[str, str | None]] = set()  # files, and sections in them

    def stays(file: str, part: Part) -> bool:
        if part.name is not None:
            return part.name in named[file]
        return not part.serves or (file, part.section) in in_use

    while found := {k for k, each in enumerate(parts) if k not in kept and stays(*each)}:
        kept |= found
        for file, part in map(parts.__getitem__, found):
            for under in below[file]:
                named[under] |= part.words
            if not part.serves:
                in_use |= {(file, None), (file, part.section)}
    return kept


@cache
def parts_of(text: str) -> tuple[Part, ...]:
    """The file in parts, whose texts follow one another in it."""
    found: list[Part] = []
    plain, begin, section = without_comments(text), 0, None
    for end in _ends(plain):
        sentence = plain[begin:end].strip()
        if section is None and (opened := _SECTION.match(sentence)):
            section = opened[1]
        found.append(_part(text[begin:end], sentence, section))
        if sentence == f"End {section}.":
            section = None
        begin = end
    return (*found, Part(text[begin:], frozenset(), None, None, serves=True))


def _part(text: str, sentence: str, section: str | None) -> Part:
    named, imports = _NAMED.match(sentence), _IMPORTS.match(sentence)
    serving = _OF_A_FILE if section is None else _OF_A_SECTION
    words = frozenset() if imports else words_of(sentence)
    serves = bool(imports or serving.match(sentence))
    return Part(text, words, named[1] if named else None, section, serves)


def _ends(plain: str) -> Iterator[int]:
    """Where the sentences end, those that a proof follows with their proofs."""
    at = 0
    while found := _END_OF_SENTENCE.search(plain, at):
        at = found.end()
        if _PROOF.match(plain, at):
            proof = _END_OF_PROOF.search(plain, at)
            at = proof.end() if proof else len(plain)
        yield at


def words_of(plain: str) -> frozenset[str]:
    """The words of a text without comments, any of which may be a name."""
    return frozenset(_WORD.findall(plain))


def without_comments(text: str) -> str:
    """The text with blanks in the place of its comments, of which some stand within others."""
    pieces, depth, begin = [], 0, 0
    for found in _COMMENT.finditer(text):
        opens = found[0] == "(*"
        depth += 1 if opens else -1
        if opens and depth == 1:
            pieces.append(text[begin : found.start()])
            begin = found.start()
        elif depth == 0:
            pieces.append(re.sub(r"[^\n]", " ", text[begin : found.end()]))
            begin = found.end()
    return "".join([*pieces, text[begin:]])


FOLDER = Path(__file__).parent / "theory"
LOGICAL = "AreaPreservation"  # by which coqc knows the folder

_IMPORT = re.compile(rf"^From {LOGICAL} Require Import ([^.]*)\.\n", re.MULTILINE)
_LIBRARY = re.compile(r"^From Coq Require Import ([^.]*)\.\n", re.MULTILINE)


@cache
def files() -> dict[str, Path]:
    """The files of the theory by their names, which are different in all folders."""
    return {path.stem: path for path in sorted(FOLDER.rglob("*.v"))}


@cache
def text_of(name: str) -> str:
    """The file of this name as it stands."""
    return files()[name].read_text(encoding="utf-8")


def imports_of(name: str) -> list[str]:
    """The files that it imports."""
    return _words(_IMPORT, text_of(name))


def in_order(names: Iterable[str]) -> list[str]:
    """These files and all that they stand on, each after what it imports."""
    ordered: dict[str, None] = {}

    def add(name: str) -> None:
        if name not in ordered:
            for below in imports_of(name):
                add(below)
            ordered[name] = None

    for name in names:
        add(name)
    return list(ordered)


def imported(names: Iterable[str]) -> str:
    """The line by which a file imports these from an installed theory."""
    return f"From {LOGICAL} Require Import {' '.join(names)}.\n"


def as_modules(names: Iterable[str], by: str) -> str:
    """What the text `by` needs of these files, and of what they stand on, as modules in one file.

    It ends with the line that imports them.
    """
    names = list(names)
    ordered = in_order(names)
    # Libraries are imported once for all modules: each time takes a fifth of a second. Every file
    # says which scopes it means, and its own names are imported after theirs.
    library = sorted({word for name in ordered for word in _words(_LIBRARY, text_of(name))})
    below = {name: in_order([name]) for name in ordered}
    files = needed({name: text_of(name) for name in ordered}, below, by)
    modules = [
        f"Module {name}.\n{_inside(text, files)}End {name}.\n" for name, text in files.items()
    ]
    loaded = f"From Coq Require Import {' '.join(library)}.\n"
    return "\n".join([loaded, *modules, _import(names, files)])


def _words(pattern: re.Pattern[str], text: str) -> list[str]:
    return [word for found in pattern.findall(text) for word in found.split()]


def _inside(text: str, files: Container[str]) -> str:
    """A file within a module, which imports those of these files that it did."""
    own = _IMPORT.sub(lambda found: _import(found[1].split(), files), text)
    return _LIBRARY.sub("", own)


def _import(names: Iterable[str], files: Container[str]) -> str:
    left = [name for name in names if name in files]
    return f"Import {' '.join(left)}.\n" if left else ""


def install(folder: Path) -> list[Path]:
    """Writes the theory there, with the project file that `coq_makefile` takes.

    Raises InputError where a file cannot be written.
    """
    written = []
    for name in in_order(files()):
        path = folder / files()[name].relative_to(FOLDER)
        write_atomically(path, text_of(name))
        written.append(path)
    listed = "".join(f"{path.relative_to(folder).as_posix()}\n" for path in written)
    write_atomically(folder / "_CoqProject", f"-Q . {LOGICAL}\n{listed}")
    return written
