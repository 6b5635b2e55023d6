"""The operations that the terms need of an algebra, and those that all algebras share."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Protocol

import numpy as np

from vizlight._types import Color, Value, Vector
from vizlight.model import falloff, formulas
from vizlight.model.manifolds import ALONG, Highlight, Vectors
from vizlight.scene.light import WHITE
from vizlight.scene.view import unit
from vizlight.shading.plan import Plan


class Lamp:
    """A light of the scene, with its place among them and its highlight."""

    def __init__(self, number: int, plan: Plan) -> None:
        light = plan.scene.lights[number]
        self.number = number
        self.highlight: Highlight = plan.highlights[number]
        self.position, self.direction = light.position, light.direction
        self.intensity, self.attenuation, self.color = (
            light.intensity, light.attenuation, light.color,
        )  # fmt: skip


class Operations(Vectors, Protocol):
    """The operations of an algebra that the terms need, beside those that all algebras share."""

    def has(self, name: str) -> bool:
        """Return whether an input is given."""

    def read(self, name: str, lamp: Lamp | None = None) -> Value:
        """Return an input at the point: a vector, or a number, perhaps of one lamp."""

    def wide(self, value: float) -> Value:
        """Return a number of the plan in float64."""

    def vector(self, values: Sequence[float], *, wide: bool = False) -> Value:
        """Return a vector of the plan, in the precision of the work or in float64."""

    def difference(self, position: Vector, *, wide: bool = False) -> Value:
        """Return a position less the point, without loss of digits."""

    def work(self, x: Value) -> Value:
        """Return a number or a vector in the precision of the work."""

    def unit(self, v: Value) -> tuple[Value, Value]:
        """Return a unit vector and the length that the vector had."""

    def need(self, test: Value) -> None:
        """Mark points that fail the test as unlit."""

    def known(self, x: Value) -> None:
        """Mark points where a number is NaN as unlit."""

    def present(self, x: Value, distance: Value | None) -> Value:
        """Return x, and 0 where the distance of its cause is 0."""

    def sound(self, x: Value, other: float) -> Value:
        """Return x at points with light, else another number."""

    def added(self, total: Value | None, value: Value) -> Value:
        """Return the sum of a total over the lamps, None before the first, and a value."""

    def put(self, name: str, value: Value) -> None:
        """Store a value as a result."""

    def largest(self, rgb: Value) -> Value:
        """Return the largest channel of a colour."""


class Algebra(Operations):
    """Numbers, inputs and vector operations of the terms.

    The numbers of an algebra are used with operators, NumPy's functions, and the formulas of
    :mod:`vizlight.model.formulas`.
    """

    def __init__(self, plan: Plan) -> None:
        self.plan, self.n, self.colored = plan, plan.n, plan.colored
        #: |x_N| up to which a direction is along a line.
        self.least = ALONG * float(np.finfo(plan.dtype).eps)

    def vectors(self, name: str, k: int) -> Sequence[Value]:
        """Return the k vectors of an input at the point."""
        raise NotImplementedError

    def apart(self, v: Value) -> Value:
        """Return the length of a unit vector's residual up to which it is rounding."""
        raise NotImplementedError

    def integral(self, z: Value, shininess: float) -> Value:
        """Return G(z) of a cylinder."""
        raise NotImplementedError

    def lamps(self) -> Iterator[Lamp]:
        """Yield the lights of the scene."""
        for number in range(len(self.plan.scene.lights)):
            yield Lamp(number, self.plan)

    def way(self, direction: Vector, *, wide: bool = False) -> Value:
        """Return the unit vector of a direction of the plan."""
        return self.vector(unit(direction).tolist(), wide=wide)

    def toward(
        self, position: Vector | None, direction: Vector | None, *, far: bool
    ) -> tuple[Value, Value | None]:
        """Return the unit direction from the point to a lamp or the eye, and the distance."""
        if far or position is None:
            assert direction is not None
            return self.way(direction), None
        # The difference is normalised in the wider type, and the unit vector then rounded to the
        # work's.
        toward, distance = self.unit(self.difference(position))
        self.known(distance)
        return self.work(toward), distance

    def eye(self) -> tuple[Value, Value | None]:
        """Return the unit direction to the eye and the distance."""
        view = self.plan.scene.view
        assert view is not None
        return self.toward(view.position, view.direction, far=view.parallel)

    def depth(self) -> tuple[Value, Sequence[Value]]:
        """Return the depth of the point, and the ends and the scales of the depth cue."""
        view, cue = self.plan.scene.view, self.plan.scene.depth_cue
        assert view is not None
        assert cue is not None
        assert cue.front is not None
        assert cue.back is not None
        away = self.difference(view.position or (0.0,) * self.n, wide=True)
        # The direction of a view is toward the eye, as `away` is, so that depth grows away from the
        # eye; without an axis it is the distance.
        if view.direction is None:
            depth = np.sqrt(self.dot(away, away))
        else:
            depth = self.dot(self.way(view.direction, wide=True), away)
        self.known(depth)
        ends = cue.front, cue.back
        # A difference of two such depths might leave float64; a quarter of all of them gives the
        # same scale.
        if max(map(abs, ends)) > falloff.LARGEST_DEPTH:
            depth, ends = depth * self.wide(0.25), (cue.front / 4, cue.back / 4)
        return depth, [self.wide(x) for x in (*ends, cue.front_scale, cue.back_scale)]

    def cue_color(self) -> Value:
        """Return the colour that the depth cue fades to."""
        cue = self.plan.scene.depth_cue
        assert cue is not None
        return self.vector([cue.cue * c for c in cue.color or WHITE])

    def exposed(self, rgb: Value) -> Value:
        """Return a colour as the exposure of the scene shows it, with the same chromaticity."""
        exposure = self.plan.scene.exposure
        if exposure is None:
            return rgb
        return rgb * formulas.exposed(self.largest(rgb), self.number(exposure))

    def fur_rate(self) -> Value:
        """Return the rate log(1 - rho) at which fur lets light through, as a finite number."""
        return self.number(falloff.fur_rate(self.plan.fur, self.plan.dtype))

    def direction(self, name: str) -> Value:
        """Return the unit vector of an input; a point without one has no light."""
        unit, size = self.unit(self.read(name))
        self.need(size > 0.0)
        return self.work(unit)

    def frame(self, name: str, k: int) -> list[Value]:
        """Return orthonormal rows that span k vectors: Gram-Schmidt, each projected twice."""
        rows: list[Value] = []
        for vector in self.vectors(name, k):
            v, size = self.unit(vector)
            self.need(size > 0.0)
            # Twice is enough (Kahan): after the first projection the rest may still lean toward the
            # rows by the rounding that cancellation has laid bare.
            for again in range(2 if rows else 0):
                for row in rows:
                    v = v - self.dot(row, v) * row
                v, size = self.unit(v)
                if not again:
                    # The rest of a dependent vector is rounding; its direction means nothing.
                    self.need(size > self.apart(v))
            rows.append(v)
        return [self.work(v) for v in rows]

    def color(self, term: str, coefficient: float) -> Value:
        """Return a coefficient times the colour of the material for a term."""
        scene, material = self.plan.scene, self.plan.scene.material
        # A highlight does not take the diffuse colour: without a specular colour it has the lamp's
        # alone.
        tint = material.specular_color if term == "specular" else material.color
        rgb = np.multiply(tint or WHITE, coefficient)
        if term == "ambient":
            rgb = rgb * (scene.ambient_color or WHITE)
        return self.vector(rgb.tolist())

    def total(self) -> Total:
        """Return an empty sum over the lamps."""
        tinted = any(light.color is not None for light in self.plan.scene.lights)
        return Total(self, tinted=tinted and self.colored)


class Total:
    """A sum over the lamps: white, and by channel where a lamp has a colour."""

    def __init__(self, w: Algebra, *, tinted: bool) -> None:
        self.w, self.tinted = w, tinted
        self.white: Value = None
        self.channels: Value = None

    def __bool__(self) -> bool:
        return self.white is not None

    @property
    def rgb(self) -> Value:
        """The sum by channel, or the white one."""
        return self.channels if self.tinted else self.white

    def add(self, value: Value, color: Color | None) -> None:
        """Add the light of one lamp."""
        # By channel only where a lamp has a colour of its own; else the material's colour times
        # the white sum is the same for a third of the work.
        self.white = self.w.added(self.white, value)
        if self.tinted:
            self.channels = self.w.added(self.channels, self.w.vector(color or WHITE) * value)
