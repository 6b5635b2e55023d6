"""The options of light: the one list that filters, command line and plan take theirs from."""

from __future__ import annotations

import dataclasses
import difflib
import functools
import inspect
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias, TypedDict, get_args

import numpy as np

from vizlight import _check, _words

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import ParamSpec, TypeVar

    from numpy.typing import ArrayLike

    P = ParamSpec("P")
    R = TypeVar("R")

Model = Literal["phong", "blinn", "cylinder"]
Precision = Literal["float32", "float64"]
#: Limits of a given exponent of the diffuse term: beyond them a picture has one brightness.
LEAST_EXPONENT, LARGEST_EXPONENT = 1e-6, 1e6
#: Largest number of voxels along a side of a bundle's grid.
FINEST_GRID = 1024
Exponent: TypeAlias = float | Literal["compensated"]
FeatureAngle: TypeAlias = float | Literal["auto"] | None
Facing = Literal["auto", "eye", "outward", "as given"]


#: Least error between points that light is refined to: rounding in float32 is about 1e-6.
FINEST = 1e-5


@dataclass(frozen=True)
class Bundle:
    """Light inside a bundle of lines, which are taken for a medium of thin cylinders.

    Parameters
    ----------
    diameter : float, optional
        Diameter of the lines that take the light, in the unit of the mesh. Default: the one at
        which the median point of the lines has the optical depth ``depth``, but at most 1/500 of
        the diagonal of their bounding box, so that few lines stay bright.
    depth : float, default: 2.0
        Optical depth, as a mean over all directions, that the default diameter aims at: 2 leaves
        about 1/7 of the light.
    directions : int, default: 64
        Number of directions, even, of the light from all sides; 0 leaves the ambient term as it
        is.
    grid : int, default: 128
        Number of voxels along the longest side of the bounding box of the lines, from 4 to 1024.
        Memory grows with its third power. A voxel is at least two diameters wide.
    lines : pyvista.DataSet or pyvista.MultiBlock, optional
        Lines that dim what is lit, such as a surface among them. Default: all lines of the mesh
        that is lit, which dim its surfaces as well.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit.

    Notes
    -----
    The share of light that reaches a point is ``exp(-d sum(l |w x t|) / A)``, summed over the
    segments, of length l and tangent t, of all other lines in the column of cross section A from
    the point toward the light w (Beer and Lambert). Banks (7) is this law for fibres across the
    light: ``1 - rho = exp(-d l / V)``, l the length in the volume V; he leaves out ``|w x t|``. A
    medium has no single lines: where few, thick lines stand in the way, points are evenly dim in
    place of dark and bright. For isotropic, parallel and layered lines the mean share of all points
    differs from rays among cylinders by at most 0.01, for a light outside, one among the lines and
    light from all sides; the study ``bundle`` measures it. At other places among the lines a light
    gave up to 0.02, and up to 0.13 where it touches a line or stands inside one, which rays find
    dark all round. Single points differ by up to 1, in magnitude by 0.06 to 0.14 on average. The
    share at a point of a single line is within 0.06 of 1.

    Examples
    --------
    >>> import vizlight
    >>> vizlight.Bundle(depth=1.0).directions
    64
    """

    diameter: float | None = None
    depth: float = 2.0
    directions: int = 64
    grid: int = 128
    lines: object = None

    def __post_init__(self) -> None:
        if self.diameter is not None:
            least = float(np.finfo(np.float64).tiny)
            _check.set_fields(self, diameter=_check.number("diameter", self.diameter, low=least))
        directions = _check.integer("directions", self.directions, low=0)
        if directions % 2:
            raise ValueError(_check.message("directions", "an even number", directions))
        grid = _check.integer("grid", self.grid, low=4)
        if grid > FINEST_GRID:
            raise ValueError(_check.message("grid", f"at most {FINEST_GRID}", grid))
        depth = _check.number("depth", self.depth, low=1e-6, high=1e6)
        if self.lines is not None and not hasattr(self.lines, "GetDataObjectType"):
            expected = "a PyVista mesh of lines, or None"
            raise TypeError(_check.message("Bundle(lines=)", expected, _check.describe(self.lines)))
        _check.set_fields(self, depth=depth, directions=directions, grid=grid)


class ShadingKeywords(TypedDict, total=False):
    """The fields of :class:`ShadingOptions` as keyword arguments."""

    model: Model
    exponent: Exponent
    conditioned: bool | str | None
    components: bool
    precision: Precision | None


class LightKeywords(ShadingKeywords, total=False):
    """The fields of :class:`LightOptions` as keyword arguments."""

    tangents: str | ArrayLike | None
    positions: str | None
    normals: str | ArrayLike | None
    facing: Facing
    feature_angle: FeatureAngle
    refine: float
    bundle: bool | Bundle
    name: str


@dataclass(frozen=True, kw_only=True)
class ShadingOptions:
    """How light is computed at the points, whatever arrays describe them.

    Parameters
    ----------
    exponent : float or "compensated"
        Exponent of the diffuse term, above 0 and up to 1e6. ``"compensated"`` is p(k, n), which
        gives lines the contrast of a surface (Banks 5); 1 is the plain law; under lamps of several
        colours in the picture plane 2 makes hue a code of direction. It has no effect on a
        cylinder.
    model : {"phong", "blinn", "cylinder"}
        Reflection model of the highlight. ``"cylinder"``, for lines in 3-space, is the exact light
        of a thin cylinder, diffuse and specular (Blinn's), by which the others are measured. As a
        mean over the width it is dimmer than the brightest normal of a line: raise the
        coefficients.
    conditioned : bool or str
        Whether tangents inherit the self-shadow of the surface that the normals belong to
        (Banks 6).
    components : bool, default: False
        Whether the terms ``ambient``, ``diffuse`` and ``specular`` are kept, before any depth cue.
    precision : {"float32", "float64"}, optional
        Precision of the work and the result. Default: that of the tangents or normals.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit.
    """

    model: Model = "phong"
    exponent: Exponent = "compensated"
    conditioned: bool | str | None = True
    components: bool = False
    precision: Precision | None = None

    def __post_init__(self) -> None:
        _check.choice("model", self.model, get_args(Model))
        if self.precision is not None:
            _check.choice("precision", self.precision, get_args(Precision))
        conditioned: object = self.conditioned
        if conditioned is not None and not isinstance(conditioned, str):
            names = "True, False or the name of a point array"
            conditioned = _check.boolean("conditioned", conditioned, expected=names)
        _check.set_fields(self, exponent=_exponent(self.exponent), conditioned=conditioned)
        _check.flags(self)

    def for_surface(self) -> ShadingOptions:
        """Return the options for a surface beside lines: a cylinder's highlight is Blinn's."""
        return dataclasses.replace(self, model="blinn") if self.model == "cylinder" else self


@dataclass(frozen=True, kw_only=True)
class LightOptions(ShadingOptions):
    """What a filter lights on a mesh, and how.

    Parameters
    ----------
    tangents : str or array_like, optional
        Name of a point array of ``k n`` components (k vectors of n, row after row), or its values.
        The vectors may have any length: they are orthonormalised. A cell array is averaged to the
        points as lines without sign, with a warning.
    positions : str, optional
        Name of a point array of n components with the places of the points in n-space. Default:
        the points of the mesh.
    normals : str or array_like, optional
        Name of a point array of n components with normals, or its values. Default: the active
        normals of the mesh (clear them after moving points), else those of its surface, which
        stay with the result as ``vizlight_normals`` from 256 points on.
    facing : {"auto", "eye", "outward", "as given"}
        Side of the surface that is lit. ``"auto"``: each connected piece that is closed faces
        outward, any other faces the eye at every point (with ``normals`` that are given the mesh
        counts as one piece). ``"eye"``: every point faces the eye,
        whatever piece it belongs to; with ``normals`` from data a surface in parts is then lit
        as the whole. ``"outward"``: each piece faces outward as a whole, an open one away from its
        centroid. ``"as given"``: normals as they are, those of the surface by the order of the
        corners of its faces. Without a view both sides are lit alike where the eye would choose.
    feature_angle : float or "auto", optional
        Angle in degrees between two faces above which points on their common edge are split, so
        that light does not bend across it; only for normals that are computed. ``"auto"``: 30 if
        the sharp edges are creases, which stand apart from the others, else none is split.
        Default: none is split.
    conditioned : bool or str, default: False
        Whether tangents inherit the self-shadow of the surface: diffuse and specular term of each
        light times ``max(0, N . wi)`` (Banks 6). A surface of codimension 2 or more has no sides
        and no such shadow: name the point array of its j tangents, such as ``"frame"``, and its
        own brightness ``sin(a)^p(j, n)`` is the factor. In codimension 1 that is ``|N . wi|``.
    refine : float, default: 0.0
        Largest error between the points, such as 1/255: segments and triangles are split where
        interpolation of the light would be further off, see :func:`vizlight.refine`. 0: the mesh
        stays as it is.
    bundle : bool or Bundle, default: False
        Whether lines dim one another, and surfaces among them, as a bundle of thin cylinders; a
        :class:`vizlight.Bundle` says how. The point arrays ``transmittance``, with one component
        per light of intensity above 0, and ``occlusion``, 1 for a point that is open to all
        sides, multiply each light and the ambient term. They are computed anew only where lines,
        lights or points have changed.
    name : str, default: "luminance"
        Name of the result. Under another name the further arrays are ``<name>_diffuse`` and so on.
    """

    tangents: str | ArrayLike | None = None
    positions: str | None = None
    normals: str | ArrayLike | None = None
    facing: Facing = "auto"
    feature_angle: FeatureAngle = None
    conditioned: bool | str | None = False
    refine: float = 0.0
    bundle: bool | Bundle = False
    name: str = "luminance"

    def __post_init__(self) -> None:
        super().__post_init__()
        _check.set_fields(self, bundle=checked_bundle(self.bundle))
        _check.set_fields(self, refine=_check.number("refine", self.refine, low=0.0))
        if 0 < self.refine < FINEST:
            expected, remedy = f"0 or {FINEST:g} at least", "a picture shows 1/255"
            raise ValueError(_check.message("refine", expected, self.refine, remedy))
        check_sides(self.facing, self.feature_angle)


def checked_bundle(value: object) -> bool | Bundle:
    """Return False or a bundle, which a record holds as a dict."""
    if isinstance(value, Mapping):
        known = [field.name for field in dataclasses.fields(Bundle)]
        if not set(value) <= set(known):
            got = _check.describe(sorted(map(str, value)))
            raise ValueError(_check.message("bundle", f"a dict of {', '.join(known)}", got))
        value = Bundle(**value)
    if isinstance(value, Bundle):
        return value
    wanted = _check.boolean("bundle", value, expected="True, False or a vizlight.Bundle")
    return Bundle() if wanted else False


def check_sides(facing: object, feature_angle: object) -> None:
    """Check the options of the side of a surface that is lit, and of its edges.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit.
    """
    _check.choice("facing", facing, get_args(Facing))
    if feature_angle is not None and not _is_auto(feature_angle):
        expected = "a number of degrees from 0 to 180, 'auto' or None"
        if isinstance(feature_angle, str):
            raise ValueError(_check.message("feature_angle", expected, repr(feature_angle)))
        _check.number("feature_angle", feature_angle, low=0.0, high=180.0)


def _exponent(value: object) -> Exponent:
    """Return an exponent of the diffuse term that has been checked."""
    if isinstance(value, str) and value == "compensated":
        return "compensated"
    if isinstance(value, str):
        expected = "a number above 0, or 'compensated'"
        raise ValueError(_check.message("exponent", expected, repr(value)))
    return _check.number("exponent", value, low=LEAST_EXPONENT, high=LARGEST_EXPONENT)


def _is_auto(value: object) -> bool:
    return isinstance(value, str) and value == "auto"


def documented(kind: type) -> dict[str, str]:
    """Return the description of each field of an options class, those of its own first."""
    found: dict[str, str] = {}
    for owner in kind.__mro__:
        for name, text in _words.parameters(owner.__dict__.get("__doc__")).items():
            found.setdefault(name, text)
    return found


def accepts(
    kind: type,
    *,
    without: tuple[str, ...] = (),
) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Let a function take the fields of an options class as keywords.

    The function has ``**options``. They appear one by one in its signature and, in place of the
    entry ``**options``, in its documentation; a keyword that is not among them is an error.

    Parameters
    ----------
    kind : type
        The options class, a dataclass.
    without : tuple of str
        Fields that the function does not take.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        signature = inspect.signature(function)
        own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
        left_out = {*without, *(p.name for p in own)}
        fields = {f.name: f for f in dataclasses.fields(kind) if f.name not in left_out}
        texts = {name: text for name, text in documented(kind).items() if name in fields}
        known = [*(p.name for p in own), *texts]

        required = {name for name in texts if fields[name].default is dataclasses.MISSING}

        @functools.wraps(function)
        def method(*arguments: P.args, **keywords: P.kwargs) -> R:
            for name in keywords:
                if name not in known:
                    owner = function.__qualname__.removesuffix(".__init__")
                    raise TypeError(unknown_option(owner.rpartition(".")[2], name, known))
            for name in required - keywords.keys():
                raise TypeError(_check.message(name, f"a value for {function.__name__}", "none"))
            return function(*arguments, **keywords)

        added = [
            inspect.Parameter(
                name,
                inspect.Parameter.KEYWORD_ONLY,
                default=inspect.Parameter.empty if name in required else fields[name].default,
                annotation=fields[name].type,
            )
            for name in texts
        ]
        listed = signature.replace(parameters=[*own, *added])
        entries = "\n".join(filter(None, texts.values()))
        text = re.sub(r"^\*\*options.*(\n    .*)*", lambda _: entries, _doc(function), flags=re.M)
        method.__signature__ = listed  # type: ignore[attr-defined]
        method.__doc__ = text
        return method

    return decorate


def _doc(function: Callable[..., object]) -> str:
    return inspect.cleandoc(function.__doc__ or "")


def unknown_option(function: str, name: str, known: list[str]) -> str:
    """Return the message for a keyword that a function does not have."""
    near = difflib.get_close_matches(name, known, n=1)
    remedy = f"did you mean {near[0]}=?" if near else f"it has {', '.join(known[1:])}"
    return _check.message(name, f"an option of {function}", "a name that it does not have", remedy)
