"""The meter gives the answers that are known, and would not if it were broken."""

import numpy as np
import pytest
from closed_cases import CASES

from vizlight.observers import readers


@pytest.mark.parametrize("name", CASES)
def test_known_answer(name):
    CASES[name]()


class Unturned:
    """A generator whose candidates start at the truth, so that ties favour it."""

    def __init__(self, random):
        self._random = random

    def uniform(self, low, high, size=None):
        return np.zeros(size) if size is not None else 0.0

    def __getattr__(self, name):
        return getattr(self._random, name)


def ties_favor_the_truth(monkeypatch):
    real = readers.find_direction
    monkeypatch.setattr(readers, "find_direction", lambda s, r, noise: real(s, Unturned(r), noise))


def likely_is_unlikely(monkeypatch):
    real = readers.posterior

    def flipped(observed, table, noise):
        inverse = 1 / np.maximum(real(observed, table, noise), 1e-12)
        return inverse / inverse.sum(axis=1, keepdims=True)

    monkeypatch.setattr(readers, "posterior", flipped)


def noise_is_not_allowed_for(monkeypatch):
    real = readers.posterior
    monkeypatch.setattr(readers, "posterior", lambda o, t, _: real(o, t, 1e-5))


def slope_is_across_the_eye(monkeypatch):
    monkeypatch.setattr(readers, "steepness", lambda s: np.abs(s.tangents[:, 0, 0]))


def normals_have_a_wrong_frame(monkeypatch):
    real = readers._in_space
    monkeypatch.setattr(readers, "_in_space", lambda s, local: real(s, local[:, [1, 0, 2]]))


def key_is_turned(monkeypatch):
    real = readers.key
    monkeypatch.setattr(readers, "key", lambda s, m, angles: real(s, m, angles + 0.1))


def bar_is_off_by_half_a_step(monkeypatch):
    real = readers.decode

    def shifted(colors, positions, bar):
        return real(colors, positions + 0.5 / len(bar), bar)

    monkeypatch.setattr(readers, "decode", shifted)


MUTATIONS = {
    ties_favor_the_truth: "headlight_on_a_plane_is_chance_share",
    likely_is_unlikely: "two_colors_60_degrees_apart_resolve_it",
    noise_is_not_allowed_for: "two_grays_tell_what_the_binary_channel_does",
    slope_is_across_the_eye: "cylinder_under_a_headlight_orders_slopes",
    normals_have_a_wrong_frame: "three_lamps_solve_for_the_normal",
    key_is_turned: "key_reads_a_plane_that_is_the_key",
    bar_is_off_by_half_a_step: "unlit_colors_are_read_to_half_a_step",
}


@pytest.mark.parametrize("mutate", MUTATIONS, ids=lambda f: f.__name__)
def test_a_broken_meter_is_noticed(monkeypatch, mutate):
    mutate(monkeypatch)
    with pytest.raises(AssertionError):
        CASES[MUTATIONS[mutate]]()


def test_black_and_white_have_the_ends_of_lightness():
    np.testing.assert_allclose(readers.lab(np.zeros(3)), 0, atol=1e-12)
    np.testing.assert_allclose(readers.lab(np.ones(3)), [100, 0, 0], atol=0.01)


def test_candidates_of_tangents_are_turned_evenly():
    normals, tangents = readers._disc(5, 8, 0.3)
    tangents = tangents.reshape(8, 5, 3)
    np.testing.assert_allclose(
        np.einsum("ij,ij->i", normals, tangents.reshape(-1, 3)), 0, atol=1e-12
    )
    turned = np.einsum("tij,tij->ti", tangents[:-1], tangents[1:])
    np.testing.assert_allclose(turned, np.cos(np.pi / 8))
