"""The formulas a second time: one point at a time, mpmath at 50 digits, no code shared.

Inputs are taken as the exact numbers that the floats are; frames and directions are made
orthonormal here, in 50 _digits.
"""

from __future__ import annotations

import math

import numpy as np

from vizlight.studies._digits import (
    diffuse,
    dot,
    exact,
    mean_intensity,
    mp,
    orthonormal,
    specular,
    split,
    unit,
)

__all__ = [
    "diffuse",
    "dot",
    "exact",
    "mean_intensity",
    "mp",
    "orthonormal",
    "specular",
    "split",
    "unit",
]


def toward(owner, point):
    """Return direction and distance to a light or an eye; None at infinity."""
    if owner.position is None or getattr(owner, "parallel", False):
        return unit(exact(owner.direction)), None
    difference = [a - b for a, b in zip(exact(owner.position), point, strict=True)]
    return unit(difference), mp.sqrt(dot(difference, difference))


def shade(point, tangents, normal, scene, *, exponent, model="phong", two_sided=False):
    """Return (ambient, diffuse, specular, luminance, rgb) of one point, term by term."""
    point, material = exact(point), scene.material
    eye, distance = toward(scene.view, point)
    normal = None if normal is None else unit(exact(normal))
    frame = None if tangents is None else orthonormal(exact(tangents))
    white = (1, 1, 1)
    ambient = exact(material.ambient) * exact(scene.ambient_intensity)
    sums = {"diffuse": [mp.mpf(0)] * 4, "specular": [mp.mpf(0)] * 4}
    for light in scene.lights:
        wi, d = toward(light, point)
        scale = exact(light.intensity)
        if d is not None:
            c1, c2, c3 = exact(light.attenuation)
            scale *= min(mp.mpf(1), 1 / (c1 + c2 * d + c3 * d * d))
        facing = None
        if normal is not None:
            facing = dot(normal, wi)
            facing = abs(facing) if two_sided else max(facing, mp.mpf(0))
        half = [a + b for a, b in zip(wi, eye, strict=True)]
        if frame is not None:
            if facing is not None:
                scale *= facing
            along_i, sine_i = split(wi, frame)
            along_o, sine_o = split(eye, frame)
            sine, mirror = sine_i, sine_i * sine_o - dot(along_i, along_o)
            h = split(unit(half), frame)[1]
        else:
            sine, n_i, n_o = facing, dot(normal, wi), dot(normal, eye)
            mirror = 2 * n_i * n_o - dot(wi, eye)
            h = dot(unit(half), normal)
            if two_sided:
                mirror = abs(n_i) * abs(n_o) + n_i * n_o - dot(wi, eye)
                h = abs(h)
            elif n_i <= 0:
                mirror = h = mp.mpf(0)
        base = mirror if model == "phong" else h
        terms = {
            "diffuse": exact(material.diffuse) * sine ** exact(exponent),
            "specular": exact(material.specular)
            * max(base, mp.mpf(0)) ** exact(material.shininess),
        }
        for name, term in terms.items():
            tint = (1, *(light.color or white))
            sums[name] = [
                s + scale * term * exact(c) for s, c in zip(sums[name], tint, strict=True)
            ]
    diffuse, specular = sums["diffuse"], sums["specular"]
    colour, shine = exact(material.color or white), exact(material.specular_color or white)
    tint = exact(scene.ambient_color or white)
    luminance = ambient + diffuse[0] + specular[0]
    rgb = [
        colour[i] * (ambient * tint[i] + diffuse[i + 1]) + shine[i] * specular[i + 1]
        for i in range(3)
    ]
    cue = scene.depth_cue
    if cue is not None:
        view = scene.view
        if view.direction is None:
            depth = distance
        else:
            origin = exact(view.position) if view.position else [mp.mpf(0)] * len(point)
            back = [a - b for a, b in zip(origin, point, strict=True)]
            depth = dot(unit(exact(view.direction)), back)
        t = (depth - exact(cue.back)) / (exact(cue.front) - exact(cue.back))
        t = min(max(t, mp.mpf(0)), mp.mpf(1))
        t = t * t * (3 - 2 * t) if cue.smooth else t
        s = exact(cue.back_scale) + exact(cue.front_scale - cue.back_scale) * t
        luminance = s * luminance + (1 - s) * exact(cue.cue)
        rgb = [
            s * c + (1 - s) * exact(cue.cue) * exact(k)
            for c, k in zip(rgb, cue.color or white, strict=True)
        ]
    return ambient, diffuse[0], specular[0], luminance, rgb


def eps(dtype):
    return float(np.finfo(dtype).eps)


def units(value, reference, dtype):
    """Return |value - reference| in eps of the type."""
    return float(abs(exact(value) - reference)) / eps(dtype)


def frames(random, count, k, n, dtype):
    """Return random orthonormal frames, rounded to the type."""
    q, _ = np.linalg.qr(random.standard_normal((count, n, k)))
    return np.swapaxes(q, 1, 2).astype(dtype)


def hard_directions(random, frame, dtype):
    """Return directions that are hard for a frame (k, n): in, near and across its space."""
    k, n = frame.shape
    tangent = random.standard_normal(k) @ frame.astype(float)
    tangent /= np.linalg.norm(tangent)
    other = random.standard_normal(n)
    normal = other - frame.T.astype(float) @ (frame.astype(float) @ other)
    normal /= np.linalg.norm(normal)
    found = [other / np.linalg.norm(other), tangent, -tangent, normal]
    for step in (0.03, 1e-2, 1e-3, 1e-4, 1e-8, 1e-12):
        found += [tangent + step * normal, normal + step * tangent]
    found = [np.asarray(v, dtype=dtype) for v in found]
    nudged = found[1].copy()
    nudged[0] = np.nextafter(nudged[0], dtype(math.inf))
    return [*found, nudged]


def reflections(random, wi, frame, dtype):
    """Return eyes for a light: any, near the reflection of wi, opposite, and at wi itself."""
    f, w = frame.astype(float), wi.astype(float)
    along = f.T @ (f @ w)
    other = random.standard_normal(len(w))
    normal = other - f.T @ (f @ other)
    normal *= np.linalg.norm(w - along) / np.linalg.norm(normal)
    mirror = normal - along
    found = [other / np.linalg.norm(other), mirror, -w, w]
    found += [mirror + step * other for step in (1e-1, 1e-3, 1e-5)]
    found += [-w + 1e-3 * other]
    return [np.asarray(v, dtype=dtype) for v in found]


def line_light(wi, wo, tangent, shininess):
    """Diffuse and specular of a thin cylinder: both laws averaged over its visible half.

    The integrals themselves, by mpmath's quadrature over normals, without a closed form.
    """
    wi, wo, t = (unit(exact(v)) for v in (wi, wo, tangent))
    eye = [x - dot(wo, t) * y for x, y in zip(wo, t, strict=True)]
    e1 = unit(eye)
    e2 = [
        t[1] * e1[2] - t[2] * e1[1],
        t[2] * e1[0] - t[0] * e1[2],
        t[0] * e1[1] - t[1] * e1[0],
    ]
    lx, ly = dot(wi, e1), dot(wi, e2)
    half = [x + y for x, y in zip(wi, wo, strict=True)]
    half = unit(half) if any(half) else half
    hx, hy = dot(half, e1), dot(half, e2)
    # A normal at angle x faces the light within a quarter turn of it, and the eye likewise.
    at = mp.atan2(ly, lx)
    low, high = max(-mp.pi / 2, at - mp.pi / 2), min(mp.pi / 2, at + mp.pi / 2)
    if low >= high or not (lx or ly):
        return mp.mpf(0), mp.mpf(0)
    s, peak = exact(shininess), mp.atan2(hy, hx)

    def lambert(x):
        return (lx * mp.cos(x) + ly * mp.sin(x)) * mp.cos(x) / 2

    def blinn(x):
        return max(hx * mp.cos(x) + hy * mp.sin(x), mp.mpf(0)) ** s * mp.cos(x) / 2

    # Cut at the highlight's place and width, which the quadrature must not miss.
    width = 1 / mp.sqrt(1 + s)
    inner = [peak + j * width for j in (-8, -4, -2, -1, 0, 1, 2, 4, 8)]
    cuts = [low, *(x for x in inner if low < x < high), high]
    return mp.quad(lambert, [low, high]), mp.quad(blinn, cuts)
