"""Files of a case of EnSight are whole and fit each other, or the case is refused."""

import numpy as np
import pytest
from refusals import refused

import vizlight
from vizlight.reading import ensight, formats

#: A tetrahedron, a polygon and a polyhedron of the points of a hexahedron, whose points have ids.
CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
HEXA = [0, 1, 3, 2, 4, 5, 7, 6]
FACES = [[0, 1, 2], [0, 1, 4], [0, 2, 4], [1, 2, 4]]


class Writer:
    """A file of EnSight, of text or of bytes."""

    def __init__(self, *, binary):
        self.binary, self.data = binary, b""

    def words(self, *lines):
        for line in lines:
            self.data += line.encode().ljust(80, b"\0") if self.binary else f"{line}\n".encode()
        return self

    def rows(self, rows, form=">i4"):
        rows = [np.atleast_1d(row) for row in rows]
        if self.binary:
            self.data += b"".join(row.astype(form).tobytes() for row in rows)
        for row in [] if self.binary else rows:
            self.words("".join(f"{x:12.5e}" if "f" in form else f"{x:10d}" for x in row))
        return self


def geometry(*, binary):
    """Return a geometry of a part of elements, and of one of a block."""
    file = Writer(binary=binary).words(*["C Binary"] * binary, "made", "", "node id given")
    file.words("element id off", "extents").rows([[0, 1]] * 3, ">f4")
    file.words("part").rows([1]).words("coordinates", "coordinates").rows([8]).rows(range(8))
    file.rows(CUBE[HEXA].T.ravel(), ">f4").words("hexa8").rows([1, np.arange(1, 9)])
    file.words("g_tetra4").rows([1, [1, 2, 3, 5]])
    file.words("nsided").rows([1, 4, [1, 2, 3, 4]])
    file.words("nfaced").rows([1, 4, *[3] * 4, *(np.array(face) + 1 for face in FACES)])
    file.words("part").rows([2]).words("a block", "block iblanked").rows([[2, 2, 2]])
    return file.rows(CUBE.T.ravel(), ">f4").rows([1] * 8).data


def values(*, binary):
    """Return values of the points of both parts, and vectors of the elements."""
    nodes = Writer(binary=binary).words("made", "part").rows([1]).words("coordinates")
    nodes.rows(range(8), ">f4").words("part").rows([2]).words("block").rows(range(8), ">f4")
    cells = Writer(binary=binary).words("made", "part").rows([1]).words("hexa8")
    cells.rows([7, 8, 9], ">f4").words("nsided").rows([1, 2, 3], ">f4")
    return nodes.data, cells.words("nfaced").rows([4, 5, 6], ">f4").data


CASE = (
    b"FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a.geo\nVARIABLE\n"
    b"vector per element: v a.vec\nscalar per node: s a.scl\n"
)
GEO = geometry(binary=False)
WRONG = {
    "twice": (CASE[:26] + CASE, GEO, "the section FORMAT stands twice"),
    "section": (CASE[:52], GEO, "no such section as b'VARI'"),
    "variable": (CASE.replace(b"per node", b"per \0"), GEO, "no such variable as"),
    "geometry": (CASE.replace(b"VARIABLE\n", b""), GEO, "no such geometry as b'vector per el"),
    "missing": (CASE.replace(b"a.geo", b"b.geo"), GEO, "'b.geo', which is missing"),
    "no step": (CASE.replace(b"a.scl", b"b.*"), GEO, r"'b.\*', which is missing"),
    "type": (CASE.replace(b"ght", b"\0\xff"), GEO, "no such type as"),
    "no name": (CASE[:-8], GEO, "names no file in the line b'scalar per node:"),
    "description": (CASE, GEO.replace(b"made\n", b""), "'a.geo': '.*' stands where 'node id'"),
    "keyword": (CASE, GEO.replace(b"hexa8", b"hexb8"), "'hexb8' stands where a part or"),
    "points": (CASE, GEO.replace(b"\ncoordinates\n     ", b"\nc\n     "), "'c' stands where"),
    "part": (CASE, GEO.replace(b"part", b"prat"), "'prat' stands where a part or its"),
    "line": (CASE, GEO.replace(b"\n 0.00000e+00\n", b"\n", 1), "32 lines are not"),
    "number": (CASE, GEO.replace(b" 1.00000e+00\n 0", b" 1.0\x8a000e+00\n 0"), "3 lines are not"),
    "count": (CASE, GEO.replace(b"hexa8\n ", b"hexa8\n-"), "a count is -1|invalid literal"),
    "nothing": (CASE, b"", "'a.geo': it is empty"),
    "size": (CASE, GEO[:-50], "4 of 8 lines are there"),
    "block": (CASE, GEO.replace(b"iblanked", b"range"), "VTK reads no block that is 'range'"),
    "no block": (CASE, GEO.replace(b"2         2\n", b"2         0\n"), r"a block of \[2, 2, 0\]"),
    "kind": (
        CASE,
        GEO.replace(b"nsided", b"point\n         1\n         1\nnsided"),
        "'a.vec': part 1 has no values of point",
    ),
    "no part": (
        CASE, GEO.partition(b"\npart\n         2")[0] + b"\n", "'a.scl': it has the part 2, which"
    ),
}  # fmt: skip


def written(folder, case, geo, *, binary=False):
    (folder / "a.geo").write_bytes(geo)
    for name, data in zip(("a.scl", "a.vec"), values(binary=binary), strict=True):
        (folder / name).write_bytes(data)
    (folder / "a.case").write_bytes(case)
    return folder / "a.case"


@pytest.mark.filterwarnings("ignore:.*blocks lack arrays")
@pytest.mark.parametrize("binary", [False, True])
def test_a_case_whose_files_fit_is_read(tmp_path, binary):
    """VTK leaves out ghost elements, and joined blocks cells of a lower dimension."""
    mesh = vizlight.read(written(tmp_path, CASE, geometry(binary=binary), binary=binary))
    assert [cell.type for cell in mesh.cell] == [12, 42, 12]
    np.testing.assert_array_equal(mesh.cell_data["v"], [[7, 8, 9], [4, 5, 6], [np.nan] * 3])
    np.testing.assert_array_equal(mesh["s"], [*range(8), *range(8)])


@pytest.mark.parametrize("kind", WRONG)
def test_cases_whose_files_do_not_fit(tmp_path, kind):
    case, geo, words = WRONG[kind]
    refused(written(tmp_path, case, geo), words)


def test_a_shift_in_a_binary_file(tmp_path):
    path = written(tmp_path, CASE, geometry(binary=True), binary=True)
    (tmp_path / "a.vec").write_bytes(b"-" + (tmp_path / "a.vec").read_bytes())
    assert formats.missing_part(path) == "'a.vec': a line has no words"


def test_a_case_that_ends_a_process_is_read_by_another(tmp_path):
    case = CASE.replace(b"s a.scl", b"1 s a.scl")
    case += b"TIME\ntime set: 1\nnumber of steps: 1\ntime values: 0\n"
    path = written(tmp_path, case, GEO)
    assert formats.missing_part(path) == ""
    with path.open("rb") as file:
        names = ("a.case", "a.geo", "a.scl", "a.vec")
        assert ensight.size(file) == sum((tmp_path / name).stat().st_size for name in names)
    path = written(tmp_path, case.replace(b"number of steps: 1\n", b""), GEO)
    refused(path, r"'.*a\.case' \(its reader was ended by|no points")


def test_each_of_several_steps_in_a_file_is_followed(tmp_path):
    case = CASE.partition(b"VARIABLE")[0]
    step = b"BEGIN TIME STEP\n" + GEO + b"END TIME STEP\n"
    assert not formats.missing_part(written(tmp_path, case, step + step))
    damaged = written(tmp_path, case, step + step.replace(b"hexa8", b"hexb8"))
    assert "'hexb8' stands where" in formats.missing_part(damaged)
