"""Cases of EnSight: files that are not whole, or do not fit each other.

VTK's reader passes over parts and values whose keywords or counts are damaged, and ends the process
at some. Source: EnSight User Manual, "EnSight Gold Casefile Format".
"""

from __future__ import annotations

import mmap
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vizlight._types import Indices, Raw
from vizlight.reading import file_parts

#: Words of a case that stand alone in a line.
_SECTIONS = (
    b"FORMAT", b"GEOMETRY", b"VARIABLE", b"TIME", b"FILE", b"MATERIAL", b"BLOCK_CONTINUATION",
    b"SCRIPTS",
)  # fmt: skip
#: Words before the colon in the section of the geometry; VTK goes round others without end.
_MODELS = (b"model", b"measured", b"match", b"boundary", b"rigid_body", b"vector_glyphs")
#: Formats, of which the last one is Gold, and kinds of variables with the words for their places.
_TYPES = [[b"ensight"], [b"ensight", b"gold"]]
_KIND = re.compile(
    rb"(?i)\s*(?:constant\s+per\s+case(?:\s+file)?"
    rb"|(complex\s+)?(scalar|vector|tensor(?:\s+a?symm?)?)\s+per\s+(measured\s+)?(node|element))\s*"
)
_NUMBERS = re.compile(rb"[\s\d.eE+-]*")
#: Numbers of a value by its kind.
_COMPONENTS = {b"scalar": 1, b"vector": 3, b"tensor symm": 6, b"tensor asym": 9}
#: Corners of an element by its kind.
_CORNERS = {
    "point": 1, "bar2": 2, "bar3": 3, "tria3": 3, "tria6": 6, "quad4": 4, "quad8": 8, "tetra4": 4,
    "tetra10": 10, "pyramid5": 5, "pyramid13": 13, "penta6": 6, "penta15": 15, "hexa8": 8,
    "hexa20": 20, "nsided": 0, "nfaced": 0,
}  # fmt: skip
#: Words of blocks by the numbers for their points: of each point, of each axis, or of the whole.
_BLOCKS = ("curvilinear", "rectilinear", "uniform")
#: Words around each of several steps in a file.
_BEGIN, _END = "begin time step", "end time step"
#: Bytes of a line of a binary file.
_LINE = 80
#: Bytes that numbers are made of, and gaps between them.
_DIGITS = np.isin(np.arange(256), np.frombuffer(b"0123456789+-.eEdD \t\r\nnaifNAIFty", np.uint8))


def missing_part(file: BinaryIO) -> str:
    """Return the reason why a case is refused, or ""."""
    folder, section, sections = Path(file.name).parent, b"", set[bytes]()
    form, named = list[bytes](), list[_Entry]()
    for text in file.read().splitlines():
        head, colon, rest = text.partition(b"#")[0].partition(b":")
        line = _Entry(head.strip(), rest, _KIND.fullmatch(head))
        if head.strip().upper() in _SECTIONS and not colon:
            section = head.strip().upper()
            if section in sections:
                return f"the section {section.decode()} stands twice"
            sections.add(section)
        elif not colon and not _NUMBERS.fullmatch(head):
            return f"no such section as {text[:40]!r}"
        elif section == b"GEOMETRY" and colon and line.head.lower() not in _MODELS:
            return f"no such geometry as {text[:40]!r}"
        elif section == b"VARIABLE" and colon and not line.kind:
            return f"no such variable as {text[:40]!r}"
        elif section == b"FORMAT" and line.head == b"type":
            form = rest.lower().split()
            if form not in _TYPES:
                return f"no such type as {rest[:40]!r}"
        elif section in (b"GEOMETRY", b"VARIABLE") and colon:
            if not line.words:
                return f"it names no file in the line {text[:40]!r}"
            named.append(line)
    return _fault_of_files(folder, named, is_gold=form == _TYPES[-1])


def size(file: BinaryIO) -> int:
    """Return the number of bytes of a case and of the files that it names, of their last step."""
    file.seek(0)
    data, folder = file.read(), Path(file.name).parent
    paths = {_of_last_step(folder, os.fsdecode(word)) for word in data.split() if b"\0" not in word}
    return len(data) + sum(path.stat().st_size for path in paths if path is not None)


class _Entry(NamedTuple):
    """A line of a case: the texts before and after its colon, and the kind of a variable."""

    head: bytes
    rest: bytes
    kind: re.Match[bytes] | None

    @property
    def words(self) -> list[bytes]:
        """Words after the colon, but for numbers of sets of times and files."""
        return [word for word in self.rest.split() if not word.isdigit()]


def _fault_of_files(folder: Path, named: list[_Entry], *, is_gold: bool) -> str:
    """Return the reason why a file that a case names is not whole, or does not fit the geometry."""
    geometry: _Geometry | None = None
    for line in named:
        kind = line.kind
        # Constants have no file, and complex values a pair of them.
        if b'"' in line.rest or (kind and (kind[1] or not kind[2])):
            continue
        name = os.fsdecode(line.words[-1 if kind else 0])
        path = _of_last_step(folder, name)
        if path is None:
            return f"it names {name!r}, which is missing"
        try:
            if is_gold and line.head == b"model":
                geometry = _Geometry(path)
            elif kind and not kind[3] and geometry:
                size = _COMPONENTS[b" ".join(kind[2].lower().split())[:11]]
                geometry.check_variable(path, size, kind[4].lower())
        except ValueError as error:
            return f"{path.name!r}: {error}"
    return ""


def _of_last_step(folder: Path, name: str) -> Path | None:
    """Return the path of a file; stars stand for the digits of a step, and the last one is read."""
    if "*" not in name:
        return folder / name if (folder / name).is_file() else None
    path = folder / name
    return max(path.parent.glob(path.name.replace("*", "[0-9]")), default=None)


def _mapped(path: Path) -> mmap.mmap:
    """Return the content of a file, which is not read at once."""
    with path.open("rb") as file:
        if not file.seek(0, 2):
            raise ValueError("it is empty")
        return mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)


class _Geometry:
    """Parts of a geometry: the numbers of values that each of them takes, by a word."""

    def __init__(self, path: Path) -> None:
        data = _mapped(path)
        begin = data[:_LINE]
        self.is_text = b"Binary" not in begin
        #: Numbers of points, and of elements, by the number of a part.
        self.of_nodes: dict[int, dict[str, int]] = {}
        self.of_elements: dict[int, dict[str, int]] = {}
        #: Whether records of Fortran are around its lines and numbers, which are not followed.
        self.unknown = b"Fortran" in begin
        if self.unknown:
            return
        file = self._opened(data)
        if not self.is_text:
            file.line()
        for _ in _steps(file):
            self.of_nodes, self.of_elements = {}, {}
            self._read_step(file)

    def _opened(self, data: mmap.mmap) -> _Text:
        return _Text(data) if self.is_text else _Binary(data)

    def _read_step(self, file: _Text) -> None:
        file.line()
        file.line()
        has_ids = []
        for what in ("node id", "element id"):
            if not (word := file.word()).startswith(what):
                raise ValueError(f"{word!r} stands where {what!r} should")
            has_ids.append(word.split()[-1] in ("given", "ignore"))
        if (word := file.word()) == "extents":
            file.skip(3, 2)
            word = file.word()
        while word == "part":
            (number,) = file.numbers(1).tolist()
            file.line()
            self.of_nodes[number], self.of_elements[number] = {}, {}
            word = file.word()
            if word.split()[:1] == ["block"]:
                self._skip_block(file, number, word.split()[1:])
                word = file.word()
            elif word == "coordinates":
                count = self.of_nodes[number][word] = file.count()
                file.skip((3 + has_ids[0]) * count)
                word = _skip_elements(file, self.of_elements[number], has_ids[1])
            else:
                raise ValueError(f"{word!r} stands where points of part {number} begin")
        _check_end(word)

    def _skip_block(self, file: _Text, number: int, words: list[str]) -> None:
        if not {*words} <= {*_BLOCKS, "iblanked"}:
            raise ValueError(f"VTK reads no block that is {' '.join(words)!r}")
        size = file.numbers(1, 3)
        count = int(size.prod())
        if size.min() < 1:
            raise ValueError(f"a block of {size.tolist()} points")
        self.of_nodes[number]["block"] = count
        self.of_elements[number]["block"] = int(np.maximum(size - 1, 1).prod())
        of_axes = 6 if "uniform" in words else int(size.sum())
        file.skip(of_axes if {*words} & {*_BLOCKS[1:]} else 3 * count)
        file.skip(count if "iblanked" in words else 0)

    def check_variable(self, path: Path, components: int, place: bytes) -> None:
        """Raise ValueError if the values of a variable are not as many as the geometry takes."""
        if self.unknown:
            return
        file = self._opened(_mapped(path))
        for _ in _steps(file):
            file.line()
            word = file.word()
            while word == "part":
                (number,) = file.numbers(1).tolist()
                if number not in self.of_nodes:
                    raise ValueError(f"it has the part {number}, which the geometry has not")
                counts = (self.of_nodes if place == b"node" else self.of_elements)[number]
                # VTK makes up values that are missing; ghost elements it leaves out.
                left = {kind for kind, count in counts.items() if count and kind[:2] != "g_"}
                word = file.word()
                while word.partition(" ")[0] in counts:
                    kind, _, how = word.partition(" ")
                    count = counts[kind]
                    left.discard(kind)
                    if how == "undef":
                        file.skip(1)
                    elif how == "partial":
                        count = file.count()
                        file.skip(count)
                    file.skip(components * count)
                    word = file.word()
                _check_end(word)
                if left:
                    raise ValueError(f"part {number} has no values of {', '.join(sorted(left))}")
            _check_end(word)


def _skip_elements(file: _Text, counts: dict[str, int], has_ids: bool) -> str:
    """Go on past the elements of a part, and return the word after them."""
    while (kind := (word := file.word()).removeprefix("g_")) in _CORNERS:
        count = counts[word] = file.count()
        file.skip(count if has_ids else 0)
        if kind == "nsided":
            file.skip_rows(file.numbers(count))
        elif kind == "nfaced":
            file.skip_rows(file.numbers(int(file.numbers(count).sum())))
        else:
            file.skip(count, _CORNERS[kind])
    return word


def _steps(file: _Text) -> Iterator[None]:
    """Go to each step of a file, of which one without words around it has one."""
    place = file.at
    if file.word() != _BEGIN:
        file.at = place
        yield
        return
    yield
    while file.word() == _BEGIN:
        yield


def _check_end(word: str) -> None:
    if word not in ("", "part", _END):
        raise ValueError(f"{word!r} stands where a part or its values begin")


class _Text:
    """Lines of a file of text, of which empty ones and comments are passed over among numbers."""

    def __init__(self, data: mmap.mmap) -> None:
        self.data = data
        #: Number of the next line.
        self.at = 0
        self._bytes: NDArray[np.uint8] = np.frombuffer(data, np.uint8)
        ends = np.flatnonzero(self._bytes == ord("\n")) + 1
        if self._bytes[-1] != ord("\n"):
            ends = np.append(ends, len(data))
        self._starts: Indices = np.concatenate([[0], ends])
        first = self._bytes[self._starts[:-1]]
        self._lines: Indices = np.flatnonzero(~np.isin(first, np.frombuffer(b"\r\n#", np.uint8)))

    def line(self) -> None:
        """Go on past a line of any words."""
        if self.at + 1 >= len(self._starts):
            raise ValueError("its end is missing")
        self.at += 1

    def word(self) -> str:
        """Return the words of the next line in small letters, none at the end."""
        try:
            begin, end = self._pass(1)
        except ValueError:
            return ""
        return " ".join(self.data[begin:end].decode("latin-1").lower().split())

    def _pass(self, count: int) -> tuple[int, int]:
        """Go on past lines, and return the places where they begin and end."""
        first = int(np.searchsorted(self._lines, self.at))
        if first + count > len(self._lines):
            raise ValueError(f"{len(self._lines) - first} of {count} lines are there")
        if not count:
            return 0, 0
        begin, self.at = self._lines[first], int(self._lines[first + count - 1]) + 1
        return int(self._starts[begin]), int(self._starts[self.at])

    def skip(self, rows: int, width: int = 1) -> None:
        """Go on past rows of numbers."""
        begin, end = self._pass(rows)
        text = self._bytes[begin:end]
        if file_parts.count_words(text) != rows * width or not _DIGITS[text].all():
            raise ValueError(f"{rows} lines are not {rows * width} numbers")

    def skip_rows(self, counts: Raw) -> None:
        """Go on past rows of other numbers of numbers."""
        self._pass(len(counts))

    def numbers(self, rows: int, width: int = 1) -> Raw:
        """Return the whole numbers of rows."""
        begin, end = self._pass(rows)
        numbers = np.array(self.data[begin:end].split(), np.int64)
        if len(numbers) != rows * width:
            raise ValueError(f"{rows} lines are not {rows * width} whole numbers")
        return numbers

    def count(self) -> int:
        """Return a number that is 0 or more."""
        (number,) = self.numbers(1).tolist()
        if number < 0:
            raise ValueError(f"a count is {number}")
        return int(number)


class _Binary(_Text):
    """Lines and numbers of a binary file of C."""

    def __init__(self, data: mmap.mmap) -> None:
        self.data = data
        #: Number of the next byte.
        self.at = 0
        self._order = ""

    def line(self) -> None:
        """Go on past a line of any words."""
        self._pass(_LINE)

    def word(self) -> str:
        """Return the words of the next line in small letters, none at the end."""
        if self.at == len(self.data):
            return ""
        begin, end = self._pass(_LINE)
        words = self.data[begin:end].partition(b"\0")[0].decode("latin-1").lower().split()
        if not words:
            raise ValueError("a line has no words")
        return " ".join(words)

    def _pass(self, count: int) -> tuple[int, int]:
        begin, self.at = self.at, self.at + count
        if not begin <= self.at <= len(self.data):
            raise ValueError(f"{len(self.data) - begin} of {count} bytes are there")
        return begin, self.at

    def skip(self, rows: int, width: int = 1) -> None:
        """Go on past rows of numbers."""
        self._pass(4 * rows * width)

    def skip_rows(self, counts: Raw) -> None:
        """Go on past rows of other numbers of numbers."""
        self._pass(4 * int(counts.sum()))

    def numbers(self, rows: int, width: int = 1) -> Raw:
        """Return the whole numbers of rows."""
        begin, end = self._pass(4 * rows * width)
        data = self.data[begin:end]
        # The first number is that of a part, which is small.
        if not self._order and data:
            self._order = min("<>", key=lambda order: np.frombuffer(data, f"{order}u4")[0])
        return np.frombuffer(data, f"{self._order or '<'}i4").astype(np.int64)
