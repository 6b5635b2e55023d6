"""Light of a grid in pieces on 1 and 2 workers, a model of its cost, and what that predicts.

The isosurface of a wavy field in a memory-mapped array is lit slab by slab. Each grid is lit by 1
and by 2 workers of one cluster in turn, so a busy machine slows both: wall times are compared only
as ratios of such pairs. The model is a sum of processor times that are proportional to the nodes,
the points of the isosurface, the pieces, and the samples of the pictures that are put together;
its coefficients are fitted to the processor times of each stage by least squares without negative
values. It is also fitted without the largest grid, to state the error where it is extrapolated, and
the covariance of the coefficients gives an interval of what it predicts. What is moved is counted
in bytes, and divided by the rate of a disk, which is measured, and by rates of a network, which are
assumed.
"""

from __future__ import annotations

import math
import os
import shutil
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyvista as pv
from scipy.optimize import nnls
from scipy.spatial import cKDTree
from scipy.stats import t as student

from studies import Row, Study, words
from vizlight import pieces
from vizlight.filters.illuminate import illuminate
from vizlight.pictures.backends import BackendError
from vizlight.pictures.cameras import camera_on
from vizlight.pieces.drawing import Layer
from vizlight.pieces.workers import local_cluster
from vizlight.scene import Scene, View

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from vizlight._types import Array

TOWARD = (1.0, 0.4, 0.7)
SCENE = Scene(view=View(direction=TOWARD))
#: What the processor time of each stage is proportional to.
STAGES = {
    "read": ("nodes read", "pieces"),
    "contour": ("nodes read", "points"),
    "light": ("points", "pieces"),
    "write": ("points", "pieces"),
    "client": ("pieces",),
    "draw": ("points", "layer samples"),
    "composite": ("layer samples",),
}
#: Stages of which the client does all.
SERIAL = ("client", "composite")
#: Size in samples of the pictures that are measured, and of a picture of 1200 x 800 pixels.
PICTURE, SAMPLES = (300, 200), 4 * 1200 * 800
#: What is predicted: nodes, workers, and nodes of a piece of 64 MB of float32.
NODES, WORKERS, SLAB = 1e12, 1000, 1.6e7
#: Layers that a task of a picture makes for each worker.
LAYERS = 2
#: Bytes of a node, of a point in the file of a lit piece, and of a sample of a layer.
NODE, POINT, SAMPLE = 4, 54, 7
#: Rates in bytes per second of a network that all workers and the client share.
NETWORKS = (1e9, 1e10)
#: Bytes that are written and read to measure the rate of a disk.
DISK = 1 << 26
#: Probability with which an interval holds what is predicted.
SHARE = 0.95


class Case(NamedTuple):
    """A grid: nodes along x and y, and along z, pieces, and waves along x."""

    side: int
    height: int
    pieces: int
    waves: float


def cases(side: int) -> dict[str, Case]:
    """Return the grids by what they vary; the second and the third have the nodes of two, four."""
    return {
        "grid": Case(side, side, 6, 2.0),
        "twice the grid": Case(side, 2 * side, 12, 2.0),
        "four times the grid": Case(side, 4 * side, 24, 2.0),
        "more pieces": Case(side, side, 18, 2.0),
        "more waves": Case(side, side, 6, 5.0),
    }


def field(case: Case) -> Array:
    """Return the gyroid with some waves along each side."""
    step = 2 * np.pi * case.waves / (case.side - 1)
    x = np.arange(case.side, dtype=np.float32) * np.float32(step)
    z = np.arange(case.height, dtype=np.float32)[:, None, None] * np.float32(step)
    y = x[:, None]
    found: Array = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    return found


def measure(side: int, repeats: int) -> list[Row]:
    """Return a row for each grid and number of workers."""
    try:
        import dask
        import distributed
    except ImportError as missing:
        text = "the study of pieces needs Dask: run pip install 'vizlight[scale]'"
        raise ImportError(text) from missing
    grids = cases(side)
    runs: dict[tuple[str, int], list[dict[str, float]]] = {}
    composite, disk = _composite(repeats), _disk()
    with (
        tempfile.TemporaryDirectory(prefix="vizlight-") as place,
        local_cluster(2) as cluster,
        distributed.Client(cluster) as client,
    ):
        sources = {name: _slabs(case, Path(place, f"{i}.npy"))
                   for i, (name, case) in enumerate(grids.items())}  # fmt: skip
        addresses = list(client.scheduler_info()["workers"])
        light = partial(_run, Path(place), client)
        light(sources["grid"], grids["grid"], draw=True)  # all is imported and OpenGL is ready
        for _ in range(repeats):
            for name, case in grids.items():
                for count in (1, 2):
                    with dask.annotate(workers=addresses[:count]):
                        found = light(sources[name], case, draw=count == 1)
                        runs.setdefault((name, count), []).append(found)
        lit = light(sources["grid"], grids["grid"], keep=True)
        error = _error(lit["meshes"], grids["grid"])
    same = {"error": error, "composite": composite, "disk": disk}
    return [_row(grids[name], name, count, runs, same) for name, count in runs]


def _slabs(case: Case, path: Path) -> pieces.Slabs:
    np.save(path, field(case))
    return pieces.Slabs({"s": np.load(path, mmap_mode="r")})


def _run(
    place: Path, client: Any, source: pieces.Slabs, case: Case, *, draw: bool = False,
    keep: bool = False,
) -> dict[str, Any]:  # fmt: skip
    """Light a grid by the workers of a client, or by this process without one.

    Returned are the processor seconds of each stage, the wall time and counts.
    """
    size = 4e-6 * case.side**2 * math.ceil((case.height - 1) / case.pieces)
    start = time.perf_counter(), time.process_time()
    lit = pieces.light(
        source, SCENE, contour="s", level=0.0, normals="gradient", slab=size * 1.0001,
        out=place / "lit.pvtp", **({"client": client} if client else {"workers": 1}),
    )  # fmt: skip
    wall, own = time.perf_counter() - start[0], time.process_time() - start[1]
    found: dict[str, Any] = {
        "s": wall, **lit.seconds, "client": own, "points": lit.points,
        "pieces": len(lit.files) + lit.empty, "load": os.getloadavg()[0],
    }  # fmt: skip
    if keep:
        found["meshes"] = [pv.read(path) for path in lit.files]
    if draw:
        found |= _drawn(lit)
    shutil.rmtree(lit.path.with_suffix(""))
    return found


def _drawn(lit: pieces.Lit) -> dict[str, float]:
    """Return the processor seconds of a picture by this process, or nothing without OpenGL."""
    camera = camera_on(lit.bounds, TOWARD, aspect=PICTURE[0] / PICTURE[1])
    start = time.process_time()
    try:
        next(pieces.pictures([lit], camera=camera, size=PICTURE, samples=1, workers=1))
    except BackendError:
        return {}
    return {"draw": time.process_time() - start}


def _error(found: Sequence[pv.PolyData], case: Case) -> float:
    """Return the largest difference of luminance from that of the whole, lit by one process."""
    values = field(case)
    whole = pv.ImageData(dimensions=values.shape[::-1])
    whole["s"] = values.ravel()
    whole = whole.compute_derivative(scalars="s", gradient="gradient").contour([0.0], scalars="s")
    whole = illuminate(whole, SCENE, normals="gradient", facing="eye")
    places = cKDTree(whole.points)
    worst = 0.0
    for part in found:
        away, at = places.query(part.points)
        assert np.max(away) < 1e-3
        worst = max(worst, float(np.abs(part["luminance"] - whole["luminance"][at]).max()))
    return worst


def _composite(repeats: int) -> float:
    """Return the processor seconds in which the client puts a layer over others, per sample."""
    random = np.random.default_rng(4)
    shape = PICTURE[::-1]
    one, two = (
        Layer(random.integers(0, 256, (*shape, 3), np.uint8), random.random(shape), last=True)
        for _ in range(2)
    )
    times = []
    for _ in range(5 * repeats):
        start = time.process_time()
        for _ in range(10):
            one.over(two)
        times.append((time.process_time() - start) / (10 * math.prod(shape)))
    return min(times)


def _disk() -> float:
    """Return the bytes per second that are read from a file which is not in memory."""
    with tempfile.NamedTemporaryFile(prefix="vizlight-") as file:
        file.write(np.random.default_rng(5).bytes(DISK))
        file.flush()
        os.fsync(file.fileno())
        if hasattr(os, "posix_fadvise"):
            os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)
        start = time.perf_counter()
        file.seek(0)
        while file.read(1 << 24):
            pass
        return float(DISK / (time.perf_counter() - start))


def _row(
    case: Case, name: str, count: int, runs: Mapping[tuple[str, int], list[dict[str, float]]],
    more: Mapping[str, float],
) -> Row:  # fmt: skip
    """Return the row of a grid and a number of workers: the shortest processor times."""
    own, single = runs[name, count], runs[name, 1]
    found = {key: min(run[key] for run in own) for key in own[0]}
    # A piece reads the slice that it shares, and one more on each side.
    nodes = case.side**2 * (case.height - 3 + 3 * found["pieces"])
    pairs = [one["s"] / other["s"] for one, other in zip(single, own, strict=True)]
    stages = {stage: found[stage] for stage in STAGES if stage in found}
    stages["composite"] = more["composite"] * found["pieces"] * math.prod(PICTURE)
    columns = {
        "nodes read": nodes, "points": found["points"], "pieces": found["pieces"], **stages,
        "wall s": float(np.median([run["s"] for run in own])),
        "wall of 1 / this": float(np.median(pairs)),
        "load": float(np.median([run["load"] for run in own])),
        "disk GB/s": more["disk"] / 1e9,
    }  # fmt: skip
    total = sum(found[stage] for stage in ("read", "contour", "light", "write", "client"))
    workers = f"{count} worker{'s' * (count > 1)}"
    cost = 1e9 * total / (case.side**2 * case.height)
    return Row(f"{name}, {workers}", case.side**2 * case.height, more["error"], cost, columns)


def _counts(row: Row) -> dict[str, float]:
    """Return what the processor times of a row are proportional to."""
    found = {name: float(row.more[name]) for name in ("nodes read", "points", "pieces")}
    return found | {"layer samples": found["pieces"] * math.prod(PICTURE)}


def _relative(rows: Sequence[Row], stage: str, terms: Sequence[str]) -> Array:
    """Return what a stage is proportional to in each row, by its time: errors are shares of it."""
    have = [row for row in rows if stage in row.more]
    found: Array = np.array(
        [[_counts(row)[term] / float(row.more[stage]) for term in terms] for row in have]
    )
    return found


def fit(rows: Sequence[Row]) -> dict[str, dict[str, float]]:
    """Return the processor seconds of each stage for one of what it is proportional to."""
    found = {}
    for stage, terms in STAGES.items():
        if not any(stage in row.more for row in rows):
            continue
        matrix = _relative(rows, stage, terms)
        scale = matrix.max(axis=0)
        values, _ = nnls(matrix / scale, np.ones(len(matrix)))
        found[stage] = dict(zip(terms, (values / scale).tolist(), strict=True))
    return found


def modelled(
    model: Mapping[str, Mapping[str, float]], counts: Mapping[str, Any]
) -> dict[str, float]:
    """Return the processor seconds of each stage that a model predicts."""
    return {
        stage: sum(value * counts[term] for term, value in terms.items())
        for stage, terms in model.items()
    }


def residuals(rows: Sequence[Row], model: Mapping[str, Mapping[str, float]]) -> list[float]:
    """Return the share by which the modelled processor time of each row exceeds the measured."""
    found = []
    for row in rows:
        have = [stage for stage in model if stage in row.more]
        times = modelled({stage: model[stage] for stage in have}, _counts(row))
        found.append(sum(times.values()) / sum(float(row.more[stage]) for stage in have) - 1)
    return found


def with_residuals(rows: list[Row]) -> list[Row]:
    """Return the rows with the residuals of the model that is fitted to them."""
    left = residuals(rows, fit(rows))
    return [
        row._replace(more={**row.more, "model / measured - 1": share})
        for row, share in zip(rows, left, strict=True)
    ]


def extrapolation(rows: Sequence[Row]) -> float:
    """Return the largest residual of the largest grid for a model fitted to the others."""
    largest = max(float(row.parameter) for row in rows)
    small = [row for row in rows if float(row.parameter) < largest]
    large = [row for row in rows if float(row.parameter) == largest]
    return max(residuals(large, fit(small)), key=abs)


def _points(rows: Sequence[Row]) -> float:
    """Return the points of the isosurface of 1e12 nodes; they grow with the power 2/3 of these."""
    shares = [
        float(row.more["points"]) / float(row.parameter) ** (2 / 3)
        for row in rows if row.way.startswith("grid")
    ]  # fmt: skip
    return float(np.mean(shares) * NODES ** (2 / 3))


def predicted(
    rows: Sequence[Row], amplification: float = 1.0,
    model: Mapping[str, Mapping[str, float]] | None = None,
) -> dict[str, float]:  # fmt: skip
    """Return the seconds that each stage takes for 1e12 nodes on 1000 workers.

    ``amplification`` is the number of nodes that are read for each node: 4 for slabs of one layer
    of cells. The model is that of the rows by default.
    """
    counts = {
        "nodes read": NODES * amplification, "points": _points(rows), "pieces": NODES / SLAB,
        "layer samples": NODES / SLAB * SAMPLES,
    }  # fmt: skip
    times = modelled(fit(rows) if model is None else model, counts)
    if "composite" in times:
        times["composite"] *= LAYERS * WORKERS / (NODES / SLAB)
    return {
        stage: seconds if stage in SERIAL else seconds / WORKERS for stage, seconds in times.items()
    }


def interval(rows: Sequence[Row], amplification: float = 1.0) -> tuple[float, float]:
    """Return limits of the predicted seconds, by the covariance of the fitted coefficients.

    The residuals of a stage give their variance, and Student's t the reach at the probability
    ``SHARE``. The interval is that of the fit: it assumes that the model holds beyond the rows, and
    processors like that of this machine.
    """
    model = fit(rows)
    variance, freedom = 0.0, len(rows)
    for stage in model:
        terms = [term for term, value in model[stage].items() if value > 0]
        matrix = _relative(rows, stage, terms)
        left = matrix @ [model[stage][term] for term in terms] - 1
        freedom = min(freedom, len(left) - len(terms))
        spread = left @ left / (len(left) - len(terms))
        ones = [predicted(rows, amplification, {stage: {term: 1.0}})[stage] for term in terms]
        variance += float(spread * (ones @ np.linalg.solve(matrix.T @ matrix, ones)))
    reach = float(student.ppf((1 + SHARE) / 2, freedom)) * math.sqrt(variance)
    total = sum(predicted(rows, amplification).values())
    return total - reach, total + reach


def transfers(rows: Sequence[Row], amplification: float = 1.0) -> dict[str, float]:
    """Return the bytes that 1e12 nodes move: read, written, and sent to the client as layers."""
    return {
        "read": NODES * amplification * NODE,
        "write": _points(rows) * POINT,
        "layers": LAYERS * WORKERS * SAMPLES * SAMPLE,
    }


def moving(rows: Sequence[Row], amplification: float = 1.0) -> dict[str, float]:
    """Return the seconds in which those bytes are moved, by where the data are.

    On disks of the workers only the layers go over the network, of the lower rate.
    """
    moved = transfers(rows, amplification)
    own = float(rows[0].more["disk GB/s"]) * 1e9 * WORKERS
    found = {f"{rate / 1e9:g} GB/s shared": sum(moved.values()) / rate for rate in NETWORKS}
    local = (moved["read"] + moved["write"]) / own + moved["layers"] / min(NETWORKS)
    return found | {"disks of the workers": local}


def verdict(rows: Sequence[Row]) -> str:
    """Return the scaling from 1 to 2 workers, the errors of the model, and what it predicts."""
    gain = np.median(
        [float(row.more["wall of 1 / this"]) for row in rows if "2 workers" in row.way]
    )
    worst = max(residuals(rows, fit(rows)), key=abs)
    blocks = predicted(rows)
    slowest = max(blocks, key=lambda stage: blocks[stage])
    kinds = []
    for what, times in (("blocks of 64 MB", 1.0), ("slabs of one layer of cells", 4.0)):
        low, high = interval(rows, times)
        total = sum(predicted(rows, times).values())
        ways = ", ".join(f"{words(s)} s ({place})" for place, s in moving(rows, times).items())
        kinds.append(
            f"{words(total)} s ({words(low)} to {words(high)} s, {SHARE:.0%} interval of the "
            f"fit) for {what}, and to move the bytes {ways}"
        )
    return (
        f"2 workers light a grid {words(float(gain))} times as fast as 1, in the median of pairs; "
        f"the model of processor time is within {abs(worst):.0%} of each row and, fitted without "
        f"the largest grid, within {abs(extrapolation(rows)):.0%} of that; for 1e12 nodes on 1000 "
        f"workers it predicts {'; '.join(kinds)}; the stage '{slowest}' takes "
        f"{words(blocks[slowest])} s"
    )


STUDY = Study(
    approximates="light of an isosurface of a grid in pieces, by 1 and 2 workers",
    reference="the isosurface of the whole grid, lit by one process",
    parameter="nodes",
    error="largest error of luminance",
    cost="processor ns per node",
    steps=lambda quick: [lambda: with_residuals(measure(*(48, 1) if quick else (96, 3)))],
    verdict=verdict,
    axes=("parameter", "cost"),
)
