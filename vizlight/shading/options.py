"""The options of light: the one list that filters, command line and plan take theirs from."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, get_args

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Exponent, Facing, FeatureAngle, Given, Keywords, Model, Precision

if TYPE_CHECKING:
    from typing_extensions import Self

#: Limits of a given exponent of the diffuse term: beyond them a picture has one brightness.
LEAST_EXPONENT, LARGEST_EXPONENT = 1e-6, 1e6
#: Largest number of voxels along a side of a bundle's grid.
FINEST_GRID = 1024


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
    grid : int, default: 128
        Number of voxels along the longest side of the bounding box of the lines, from 4 to 1024.
        Memory grows with its third power. A voxel is at least two diameters wide.
    lines : pyvista.DataSet or pyvista.MultiBlock, optional
        Lines that dim the lit mesh, such as a surface among them. Default: all lines of the lit
        mesh, which dim its surfaces as well.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit.

    Notes
    -----
    The share of light that reaches a point is ``exp(-d sum(l |w x t|) / A)``, summed over the
    segments, of length l and tangent t, of all other lines in the column of cross section A from
    the point toward the light w (Beer and Lambert); each free end of a line adds
    ``pi / 8 d |w . t|``, half of the disc that closes it. Banks (7) is this law for fibres across
    the light: ``1 - rho = exp(-d l / V)``, l the length in the volume V; he leaves out
    ``|w x t|``. A medium has no single lines: where few, thick lines stand in the way, points are
    evenly dim in place of dark and bright.

    The mean share of all points differs from rays among solid cylinders, as a mean over 8 bundles
    of random lines, by at most 0.01: for isotropic, parallel and crossing lines and for layers,
    under a far light of any direction, for a lamp among the lines, close outside or at their end,
    and for light from all sides, which the study ``bundle`` measures; by up to 0.13 where a lamp
    stands inside a line, which rays find dark all round.

    Where lines at random overlap, half of those that cover a point stand before it. Single bundles
    of 1200 lines differ by up to 0.04, as the lines are random.

    The medium does not know of order: in a hexagonal lattice of parallel lines, 5 diameters apart,
    light at 4 degrees to the lines passes with a share of 1.00 or 0.41, by its angle to the rows,
    where the medium gives 0.85 and 0.77; across the lines, along a row, with 0.08 in place of 0.23.
    Single points differ by up to 1, in magnitude by 0.06 to 0.14 on average. On a straight single
    line, where 1 is right, the share is within 0.06 of it, as a mean over the line within 0.02,
    also under a lamp beside it as far away as the line is long; up to all of it is missing under a
    lamp in line with it, and up to 0.8 where that is 20 diameters or more from its end.
    Ends of lines are as right as their inner points, ends of lines that are no longer than 2
    diameters to 0.02.

    The record of a lit mesh, ``vizlight.provenance(lit)["bundle"]``, has the ``error`` of each
    light that 95 of 100 points keep to, and its ``mean_error``, of the mean share of the points.
    Both are estimated by rays from at most 512 points through solid cylinders.

    Examples
    --------
    >>> import vizlight
    >>> vizlight.Bundle(depth=1.0).grid
    128
    """

    diameter: float | None = None
    depth: float = 2.0
    grid: int = 128
    lines: object = None

    def __post_init__(self) -> None:
        if self.diameter is not None:
            least = float(np.finfo(np.float64).tiny)
            _check.set_fields(self, diameter=_check.number("diameter", self.diameter, low=least))
        grid = _check.integer("grid", self.grid, low=4)
        if grid > FINEST_GRID:
            raise _check.value_error("grid", f"at most {FINEST_GRID}", grid)
        depth = _check.number("depth", self.depth, low=1e-6, high=1e6)
        if self.lines is not None and not hasattr(self.lines, "GetDataObjectType"):
            expected = "a PyVista mesh of lines, or None"
            raise _check.type_error("Bundle(lines=)", expected, self.lines)
        _check.set_fields(self, depth=depth, grid=grid)


class Options:
    """Base of the options of a filter, which stand as keywords in its signature."""

    #: Fields that the filter decides by itself: no keywords of it.
    DECIDED: ClassVar[frozenset[str]] = frozenset()

    @classmethod
    def of(cls, values: Mapping[str, Given]) -> Self:
        """Return the options among the values of a function's parameters, ``locals()``."""
        fields = dataclasses.fields(cls)  # type: ignore[arg-type]
        return cls(**{field.name: values[field.name] for field in fields if field.name in values})

    def changed(self) -> Keywords:
        """Return the options that differ from their defaults."""
        changes = {}
        for field in dataclasses.fields(self):  # type: ignore[arg-type]
            value, default = getattr(self, field.name), field.default
            # Types are compared too, since 1, 1.0 and True are equal, and arrays are not compared
            # at all.
            if value is not default and not (type(value) is type(default) and value == default):
                changes[field.name] = value
        return changes


@dataclass(frozen=True, kw_only=True)
class ShadingOptions(Options):
    """Options of light at points, whatever arrays describe them.

    The fields are keywords of :func:`vizlight.shading.engine.shade`.
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
    """Options of the light of a mesh by a filter.

    The fields are keywords of :func:`vizlight.illuminate`.
    """

    tangents: str | ArrayLike | None = None
    positions: str | None = None
    normals: str | ArrayLike | None = None
    facing: Facing = "auto"
    feature_angle: FeatureAngle = None
    conditioned: bool | str | None = False
    line_field: bool = False
    bundle: bool | Bundle = False
    occlusion: str | None = None
    name: str = "luminance"

    def __post_init__(self) -> None:
        super().__post_init__()
        _check.set_fields(self, bundle=checked_bundle(self.bundle))
        joined = with_joined_names({"tangents": self.tangents, "line_field": self.line_field})
        _check.set_fields(self, tangents=joined["tangents"])
        if self.occlusion is not None:
            _check.text("occlusion", self.occlusion, expected="the name of a point array")
        check_sides(self.facing, self.feature_angle)


def with_joined_names(options: Keywords) -> Keywords:
    """Return options in which names of two or three components of tangents are one text."""
    names: object = options.get("tangents")
    # Two names of a field of lines are those of a cross field.
    is_field = _check.boolean("line_field", options.get("line_field", False))
    if is_field or not (isinstance(names, list | tuple) and len(names) in (2, 3)):
        return options
    if not all(isinstance(name, str) for name in names) or len({*names}) < len(names):
        return options
    return options | {"tangents": ",".join(names)}


def checked_bundle(value: object) -> bool | Bundle:
    """Return False or a bundle, which a record holds as a dict."""
    if isinstance(value, Mapping):
        names = [field.name for field in dataclasses.fields(Bundle)]
        if not set(value) <= set(names):
            got = _check.describe(sorted(map(str, value)))
            raise _check.value_error("bundle", f"a dict of {', '.join(names)}", got)
        value = Bundle(**value)
    if isinstance(value, Bundle):
        return value
    # True stands for a bundle of default values.
    wanted = _check.boolean("bundle", value, expected="True, False or a vizlight.Bundle")
    return Bundle() if wanted else False


def check_sides(facing: object, feature_angle: object) -> None:
    """Check the options of the side of a surface that is lit, and of its edges."""
    _check.choice("facing", facing, get_args(Facing))
    if isinstance(feature_angle, str):
        if feature_angle != "auto":
            expected = "a number of degrees from 0 to 180, 'auto' or None"
            raise _check.value_error("feature_angle", expected, repr(feature_angle))
    elif feature_angle is not None:
        _check.number("feature_angle", feature_angle, low=0.0, high=180.0)


def _exponent(value: object) -> Exponent:
    """Return an exponent of the diffuse term that has been checked."""
    if not isinstance(value, str):
        return _check.number("exponent", value, low=LEAST_EXPONENT, high=LARGEST_EXPONENT)
    if value != "compensated":
        raise _check.value_error("exponent", "a number above 0, or 'compensated'", repr(value))
    return "compensated"
