"""A small OpenFOAM case as text: a box of hexahedra, and fields of its cells at several times."""

import numpy as np

HEAD = """FoamFile
{{
    version 2.0;
    format ascii;
    class {kind};
    location "{place}";
    object {name};
}}
"""


def write(case, times, fields, n=4, before=""):
    """Write a case of n cells along each side; ``fields`` returns rows by name for the cells."""
    mesh = case / "constant" / "polyMesh"
    mesh.mkdir(parents=True)
    points, faces, owner, neighbour, middles = box(n)
    lists = {
        "points": ("vectorField", [f"({x} {y} {z})" for x, y, z in points]),
        "faces": ("faceList", [f"4({' '.join(map(str, face))})" for face in faces]),
        "owner": ("labelList", owner),
        "neighbour": ("labelList", neighbour),
    }
    for name, (kind, rows) in lists.items():
        text = "\n".join(map(str, rows))
        head = HEAD.format(kind=kind, place="constant/polyMesh", name=name)
        (mesh / name).write_text(f"{head}\n{len(rows)}\n(\n{text}\n)\n")
    head = HEAD.format(kind="polyBoundaryMesh", place="constant/polyMesh", name="boundary")
    size, start = len(faces) - len(neighbour), len(neighbour)
    (mesh / "boundary").write_text(
        f"{head}\n1\n(\nwalls {{ type wall; nFaces {size}; startFace {start}; }}\n)\n"
    )
    for time in times:
        folder = case / f"{time:g}"
        folder.mkdir()
        for name, rows in fields(time, middles).items():
            kind = "vector" if rows.ndim == 2 else "scalar"
            words = (" ".join(map(str, np.atleast_1d(row))) for row in rows)
            text = "\n".join(f"({word})" if rows.ndim == 2 else word for word in words)
            head = HEAD.format(kind=f"vol{kind.title()}Field", place=f"{time:g}", name=name)
            (folder / name).write_text(
                f"{head}{before}\ndimensions [0 1 -1 0 0 0 0];\n"
                f"internalField nonuniform List<{kind}>\n{len(rows)}\n(\n{text}\n)\n;\n"
                "boundaryField { walls { type zeroGradient; } }\n"
            )
    path = case / "case.foam"
    path.touch()
    return path


def box(n):
    """Return points, faces, owners, neighbours of inner faces, and the middles of the cells."""

    def at(i, j, k):
        return i + (n + 1) * (j + (n + 1) * k)

    def cell(i, j, k):
        return i + n * (j + n * k)

    k, j, i = np.mgrid[: n + 1, : n + 1, : n + 1]
    points = np.stack([i.ravel(), j.ravel(), k.ravel()], axis=1) / n
    inner, outer = [], []
    for a, b, c in np.ndindex(n, n, n):
        corner, own = np.array([a, b, c]), cell(a, b, c)
        for axis in range(3):
            u, v = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
            step = np.eye(3, dtype=int)[axis]
            low = [at(*(corner + s)) for s in (0 * u, v, u + v, u)]
            high = [at(*(corner + step + s)) for s in (0 * u, u, u + v, v)]
            if corner[axis] == 0:
                outer.append((low, own))
            if corner[axis] == n - 1:
                outer.append((high, own))
            else:
                inner.append((high, own, cell(*(corner + step))))
    inner.sort(key=lambda face: face[1:])
    faces = [face[0] for face in inner] + [face[0] for face in outer]
    owner = [face[1] for face in inner] + [face[1] for face in outer]
    places = np.array([(np.array([a, b, c]) + 0.5) / n for c, b, a in np.ndindex(n, n, n)])
    return points, faces, owner, [face[2] for face in inner], places
