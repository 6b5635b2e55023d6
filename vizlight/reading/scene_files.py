"""Files of scenes of VRML: each shape placed by its transforms."""

from __future__ import annotations

import itertools
import re
import threading
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyvista as pv

from vizlight import _check, _supervise
from vizlight._types import Array, Foreign, Raw

SUFFIXES = (".wrl", ".vrml")
#: VTK's parser of VRML keeps its state in variables of the process.
_LOCK = threading.Lock()
#: Texts of VRML 2, and commas and comments, which stand for a gap: VTK takes few commas.
_GAP = re.compile(r'("(?:\\.|[^"\\])*")|,|#[^\n]*')
#: Texts, brackets, runs of numbers, some in base 16, and words.
_TOKENS = re.compile(
    r'"(?:\\.|[^"\\])*"|[\[\]{}]'
    r"|[-+.\d][-+.\d\s]*(?:(?:(?<=[.\d])[eE][-+\d]|(?<=0)[xX][\da-fA-F]+)[-+.\d\s]*)*"
    r'|[^\s\[\]{}"]+'
)
#: Most tokens of a scene whose nodes that are used again are written out, and of a use of a
#: prototype.
_MOST_TOKENS, _MOST_OF_USE = 1 << 24, 1 << 20
#: Sizes of nodes that do not state them; those of VTK are half of it.
_SIZES = {
    "Box": "size 2 2 2", "Sphere": "radius 1", "Cylinder": "height 2 radius 1",
    "Cone": "height 2 bottomRadius 1",
}  # fmt: skip
#: Fields of a Transform with their values where a file has none.
_FIELDS: dict[str, tuple[float, ...]] = {
    "translation": (0.0, 0.0, 0.0), "center": (0.0, 0.0, 0.0), "rotation": (0.0, 0.0, 1.0, 0.0),
    "scale": (1.0, 1.0, 1.0), "scaleOrientation": (0.0, 0.0, 1.0, 0.0),
}  # fmt: skip
#: Those that VTK leaves out.
_LEFT_OUT = {"center", "scaleOrientation"}
#: Nodes of others, which VTK puts anywhere: they become Transforms.
_GROUPS = ("Anchor", "Billboard", "Collision", "Group", "LOD", "Switch")
#: Fields with what is in nodes.
_CHILDREN = ("children", "level", "choice")
#: Fields of three numbers for each row, which VTK takes as they come, by the node that has them.
_TRIPLES = {"Coordinate": "point", "Normal": "vector", "Color": "color"}
#: Places of a shape that show its transforms.
_ORIGIN, _AXES = np.zeros(3), np.eye(3)


def read(path: Path) -> pv.MultiBlock:
    """Return the shapes of a scene that have points, in the space of the whole."""
    with _LOCK, _supervise.folder(path) as folder:
        every = _of_vrml(path, folder / "scene.wrl")
    shapes = pv.MultiBlock(
        [
            # Normals are turned as normals, which a scale of unequal factors leaves upright.
            shape.transform(matrix, transform_all_input_vectors=False, inplace=False)
            for shape, matrix in every
            if shape is not None
        ]
    )
    if (empty := len(every) - shapes.n_blocks) and shapes.n_blocks:
        _check.warn(f"file: '{path}': {empty} of {len(every)} shapes are left out: no points")
    return shapes


def _of_vrml(path: Path, draft: Path) -> list[tuple[pv.PolyData | None, Array]]:
    """Return the shapes of a scene of VRML, each with its matrix.

    VTK keeps the place, the turn and three lengths of a product of transforms, which are not all of
    it where lengths differ: the places of the ends of the shapes' axes tell the rest.
    """
    from vtkmodules.vtkIOImport import vtkVRMLImporter

    text = path.read_bytes().decode("latin-1")
    if text.startswith("#VRML V1"):
        raise ValueError("it is VRML 1, which VTK does not read: save it as VRML 2, .glb or .obj")
    # VTK takes a quotation mark within a text for its end, and no text is a part of a mesh.
    words = _TOKENS.findall(_GAP.sub(lambda gap: '"" ' if gap[1] else " ", text))
    tokens = _written_out(words)
    if external := sorted({"EXTERNPROTO", "Inline"}.intersection(words)):
        names = ", ".join(external)
        _check.warn(f"file: '{path}': nodes of other files are left out: {names}")
    nodes = list(_nodes(tokens))
    scales = [node.fields["scale"][1] for node in nodes if "scale" in node.fields]
    skewed = any(len({*scale}) > 1 or scale[0] < 0 for scale in scales)
    results = []
    for place in [_ORIGIN, *(_AXES if skewed else ())]:
        draft.write_text(_plain(tokens, nodes, place), encoding="latin-1")
        # Two importers at a time end the process.
        importer: Foreign = vtkVRMLImporter()
        importer.SetFileName(str(draft))
        results.append(_imported(importer))
        del importer
    shapes, *ends = results
    # VTK's parser prints what it does not understand, and leaves out what follows.
    if len(shapes) != (stated := draft.read_text("latin-1").split().count("Shape")):
        raise ValueError(f"VTK reads {len(shapes)} of its {stated} shapes")
    for i, (_, matrix) in enumerate(shapes):
        for axis, others in enumerate(ends):
            matrix[:3, axis] = others[i][1][:3, 3] - matrix[:3, 3]
    return shapes


def _imported(importer: Foreign) -> list[tuple[pv.PolyData | None, Array]]:
    """Return each shape of a scene, None for one without points, with its matrix."""
    importer.Update()
    actors = importer.GetRenderer().GetActors()
    every = [actors.GetItemAsObject(i) for i in range(actors.GetNumberOfItems())]
    return [
        (_shape(actor), np.array(pv.array_from_vtkmatrix(actor.GetMatrix()), dtype=np.float64))
        for actor in every
    ]


def _shape(actor: Foreign) -> pv.PolyData | None:
    """Return a copy of the shape of an actor, None if it has no points."""
    mapper = actor.GetMapper()
    if mapper is None:
        return None
    mapper.Update()
    data = mapper.GetInput()
    if data is None or not data.GetNumberOfPoints():
        return None
    colors = _colors(data, mapper.GetLookupTable())
    if colors is not None:
        data.GetPointData().SetScalars(None)
    # What the importer made goes with it.
    shape: pv.PolyData = pv.wrap(data).copy()
    if colors is not None:
        shape.point_data["color"] = colors
    return shape


def _colors(shape: Foreign, table: Foreign) -> Raw | None:
    """Return the colours of the points of a shape, which VTK numbers, one or more too many."""
    scalars = shape.GetPointData().GetScalars()
    # Without colours in the file the table is empty.
    colors: Raw = pv.convert_array(table.GetTable())
    if scalars is None or not 0 < shape.GetNumberOfPoints() <= scalars.GetNumberOfTuples():
        return None
    numbers = pv.convert_array(scalars)[: shape.GetNumberOfPoints()].astype(np.intp)
    if numbers.ndim > 1 or not 0 <= numbers.min() <= numbers.max() < len(colors):
        return None
    return np.asarray(colors[numbers, :3])


class _Prototype(NamedTuple):
    """A node that a scene defines: the values of its fields, if a use states none, and its body."""

    fields: dict[str, list[str]]
    body: list[str]


def _instances(words: list[str], prototypes: dict[str, _Prototype]) -> Iterator[str]:
    """Yield the tokens of a scene with the bodies of its prototypes where these are used.

    VTK draws the body where it stands, too, and ends the process where it is used twice. Source:
    ISO/IEC 14772-1, 4.8.
    """
    i = 0
    while i < len(words):
        name, begin = words[i], i
        i += 1
        if name == "EXTERNPROTO":
            # After its declaration stands where it is: a group of nothing is in its place.
            i = _closing(words, _closing(words, begin))
            prototypes = prototypes | {words[begin + 1]: _Prototype({}, ["Group", "{", "}"])}
        elif name == "PROTO":
            interface, end = _closing(words, begin), _closing(words, _closing(words, begin))
            declared = _parted(words[begin + 3 : interface - 1], _ACCESS)
            prototypes = prototypes | {
                words[begin + 1]: _Prototype(
                    # An access has a type and a name after it, and then the value.
                    {field[1]: field[2:] for _, field in declared if len(field) > 1},
                    words[interface + 1 : end - 1],
                )
            }
            i = end
        elif name in prototypes and words[i : i + 1] == ["{"]:
            i = _closing(words, begin)
            fields, body = prototypes[name]
            values = fields | dict(_parted(words[begin + 2 : i - 1], fields))
            inner = {key: value for key, value in prototypes.items() if key != name}
            inside = _instances([*_filled(body, values)], inner)
            scene = [*itertools.islice(inside, _MOST_OF_USE)]
            if len(scene) == _MOST_OF_USE:
                raise ValueError("its nodes are used too often")
            # The nodes after the first one are scripts.
            yield from scene[: _closing(scene, 0)]
        else:
            yield name


#: Words before the type and the name of each field of a prototype.
_ACCESS = ("eventIn", "eventOut", "exposedField", "field")


#: Brackets that close, each with the one that it closes.
_OPENING = {"]": "[", "}": "{"}


def _depths(words: Iterable[str]) -> Iterator[int]:
    """Yield the number of brackets around each token; a bracket is not around itself.

    VTK ends the process where they do not fit.
    """
    stack: list[str] = []
    for word in words:
        if word in _OPENING and [_OPENING[word]] != stack[-1:]:
            raise ValueError("its brackets do not close")
        if word in _OPENING:
            stack.pop()
        yield len(stack)
        if word in _OPENING.values():
            stack.append(word)
    if stack:
        raise ValueError("its brackets do not close")


def _closing(words: Sequence[str], begin: int) -> int:
    """Return the number of the token after the next group in brackets."""
    depths = _depths(words[i] for i in range(begin, len(words)))
    ends = (i + 1 for i, depth in enumerate(depths, begin) if not depth and words[i] in _OPENING)
    return next(ends, len(words))


def _parted(words: list[str], names: Container[str]) -> Iterator[tuple[str, list[str]]]:
    """Yield each name that is in no brackets, with the tokens up to the next one."""
    starts = [i for i, depth in enumerate(_depths(words)) if not depth and words[i] in names]
    for start, end in itertools.pairwise([*starts, len(words)]):
        yield words[start], words[start + 1 : end]


def _filled(body: list[str], values: Mapping[str, list[str]]) -> Iterator[str]:
    """Yield the tokens of a body with values for its fields that are those of the prototype."""
    i = 0
    while i < len(body):
        if body[i + 1 : i + 2] == ["IS"]:
            # What comes in and goes out has no value.
            value = values.get("".join(body[i + 2 : i + 3]))
            yield from [body[i], *value] if value else ()
            i += 3
        else:
            yield body[i]
            i += 1


def _written_out(every: list[str]) -> list[str]:
    """Return the tokens of a scene with its nodes in all places where they are used.

    VTK leaves out the transforms of a node that is used again, and keeps names from file to file.
    """
    tokens: list[str] = []
    names: dict[str, list[str]] = {}
    # Brackets that are open: the name of what they hold, and where it begins.
    stack: list[tuple[str, int]] = []
    named, words = ("", 0), _instances(every, {})
    for word in words:
        if word == "DEF":
            named = next(words, ""), len(tokens)
        elif word == "USE":
            tokens += names.get(next(words, ""), ())
        elif word == "ROUTE":
            for _ in range(3):
                next(words, "")
        else:
            tokens.append(word)
            if word in "[{":
                stack.append(named)
                named = "", 0
                if word == "{" and len(tokens) > 1:
                    tokens.append(_SIZES.get(tokens[-2], ""))
            elif word in "]}" and stack:
                name, begin = stack.pop()
                if name:
                    names[name] = tokens[begin:]
        if len(tokens) > _MOST_TOKENS:
            raise ValueError("its nodes are used too often")
    return tokens


class _Node(NamedTuple):
    """A Transform, a Shape or a group among tokens.

    ``begin`` and ``end`` are the numbers of the tokens of its name and of its last bracket,
    ``fields`` has the token and numbers of each field of a Transform, and ``children`` the numbers
    of the token ``children``, or its like, and of the last of its content.
    """

    name: str
    begin: int
    end: int
    fields: dict[str, tuple[int, Sequence[float]]]
    children: list[int]


def _nodes(tokens: Sequence[str]) -> Iterator[_Node]:
    """Yield the Transforms, the Shapes and groups, the inner ones first."""
    stack: list[_Node] = []
    for i, (word, _) in enumerate(zip(tokens, _depths(tokens), strict=True)):
        if word in _OPENING.values():
            before = tokens[i - 1] if word == "{" and i else ""
            stack.append(_Node(before, i - 1, 0, {}, []))
            # After the bracket stands the token for sizes, and around the numbers others may.
            numbers = " ".join(tokens[i + 3 : i + 5]).strip("[{ }]").split()
            if before in _TRIPLES and (tokens[i + 2] != _TRIPLES[before] or len(numbers) % 3):
                raise ValueError(f"{before} has no {_TRIPLES[before]} of three numbers a row")
        elif word in _OPENING:
            closed = stack.pop()
            if closed.name in ("IndexedFaceSet", "IndexedLineSet"):
                _check_indices(closed.name, tokens[closed.begin : i])
            if closed.name in ("Shape", "Transform", *_GROUPS):
                yield closed._replace(end=i)
            if stack and len(stack[-1].children) == 1:
                stack[-1].children.append(i)
        elif stack and tokens[stack[-1].begin + 1] == "[" and _mixed(tokens[i - 1], word):
            raise ValueError(f"{word[:20]!r} stands after {tokens[i - 1][:20]!r} in a list")
        elif stack and word in _FIELDS and stack[-1].name == "Transform":
            values = tokens[i + 1].split()
            if len(values) != len(_FIELDS[word]):
                raise ValueError(f"{word} has {len(values)} numbers")
            stack[-1].fields[word] = i, [float(value) for value in values]
        elif stack and word in _CHILDREN:
            stack[-1].children[:] = [i]


#: Nodes with the rows that the corners of a shape have, the field of these rows, and the fields
#: of their numbers and of what they belong to.
_ROWS = (
    ("Coordinate", "point", "coordIndex", ""),
    ("TextureCoordinate", "point", "texCoordIndex", ""),
    ("Normal", "vector", "normalIndex", "normalPerVertex"),
    ("Color", "color", "colorIndex", "colorPerVertex"),
)


def _check_indices(name: str, inside: Sequence[str]) -> None:
    """Raise ValueError for a shape whose corners have numbers of rows that are not there.

    VTK takes others in their place. Source: ISO/IEC 14772-1, 6.23.
    """
    if "normalIndex" in inside and "coordIndex" not in inside:
        raise ValueError(f"{name} has a normalIndex and no coordIndex")
    corners = _listed(inside, "coordIndex")
    for node, field, index, belongs in _ROWS:
        if node not in inside:
            continue
        begin = inside.index(node)
        width = 2 if node == "TextureCoordinate" else 3
        count = len(_listed(inside[begin : begin + 7], field)) // width
        numbers = _listed(inside, index)
        if not count and (node == "Coordinate" or not len(numbers)):
            continue  # it is left out with a word, or has none of these rows
        whole = belongs not in inside or inside[inside.index(belongs) + 1] != "FALSE"
        if not len(numbers):
            # Each corner has the number of its point, and each face its own.
            numbers = corners if whole else np.arange(float(np.count_nonzero(corners == -1)))
        if len(numbers) and not -1 <= numbers.min() <= numbers.max() < count:
            wrong = numbers.max() if numbers.min() >= -1 else numbers.min()
            raise ValueError(f"{name} has the number {wrong:g} of {count} rows of {node}")


def _listed(tokens: Sequence[str], field: str) -> Array:
    """Return the numbers of a field, none without it."""
    if field not in tokens:
        return np.empty(0)
    words = "".join(tokens[tokens.index(field) + 1 : tokens.index(field) + 3]).strip("[]").split()
    return np.array(words, dtype=np.float64)


def _mixed(before: str, word: str) -> bool:
    """Return whether one of two tokens is numbers and the other a word, not a bracket."""
    numbers = [token[:1] in "+-.0123456789" for token in (before, word)]
    return before not in ("[", *_OPENING) and numbers[0] != numbers[1]


def _plain(tokens: Sequence[str], nodes: Sequence[_Node], place: Array) -> str:
    """Return a scene of Transforms without what VTK leaves out, and with shapes at a place.

    A Transform is a product of plain ones, T C R O S O⁻¹ C⁻¹ in this order. Source: ISO/IEC
    14772-1, 6.52.
    """
    words = list(tokens)
    for node in nodes:
        if node.name == "Shape" and place.any():
            words[node.begin] = f"Transform {{ translation {_text(place)} children [ Shape"
            words[node.end] += " ] }"
        if node.name in _GROUPS:
            words[node.begin] = "Transform"
            first, last = _kept(tokens, node)
            for i in (*range(node.begin + 2, first), *range(last + 1, node.end)):
                words[i] = ""
            words[node.begin + 2] = "children [" + words[node.begin + 2]
            words[node.end] = "] " + words[node.end]
        if len(node.children) < 2 or not _LEFT_OUT & node.fields.keys():
            continue
        numbers = _FIELDS | {name: field[1] for name, field in node.fields.items()}
        *axis, angle = numbers["scaleOrientation"]
        center = np.array(numbers["center"])
        for i, _ in node.fields.values():
            words[i : i + 2] = "", ""
        steps = (
            f"translation {_text(center + numbers['translation'])}"
            f" rotation {_text(numbers['rotation'])}",
            f"rotation {_text([*axis, angle])} scale {_text(numbers['scale'])}",
            f"rotation {_text([*axis, -angle])}",
            f"translation {_text(-center)}",
        )
        begin, end = node.children
        words[begin] = f"{' children [ Transform { '.join(steps)} children"
        words[end] += " } ]" * (len(steps) - 1)
    return "#VRML V2.0 utf8\n" + "\n".join(words)


def _kept(tokens: Sequence[str], node: _Node) -> tuple[int, int]:
    """Return the first and the last token that count of what is in a group."""
    if len(node.children) < 2:
        return node.end, node.end - 1
    first, last = node.children
    if tokens[first + 1] != "[":
        return first + 1, last
    first, last = first + 2, last - 1
    number = {"LOD": 0, "Switch": -1}.get(node.name)
    if number is None:
        return first, last
    if "whichChoice" in tokens[node.begin : node.end]:
        number = int(tokens[tokens.index("whichChoice", node.begin) + 1])
    inside = tokens[first : last + 1]
    depths = enumerate(_depths(inside), first)
    ends = [first, *(i + 1 for i, depth in depths if tokens[i] == "}" and not depth)]
    if not 0 <= number < len(ends) - 1:
        return node.end, node.end - 1
    return ends[number], ends[number + 1] - 1


def _text(numbers: Sequence[float] | Array) -> str:
    return " ".join(f"{number:.9g}" for number in numbers)
