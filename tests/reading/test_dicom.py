"""Images of DICOM."""

import struct

import numpy as np
import pytest
from PIL import Image
from refusals import refused

import vizlight
from vizlight.draw.map_frames import letters
from vizlight.mesh import georeference, meaning


def element(group, number, kind, value, *, named=True):
    """Return the bytes of an element, whose kind is left out in an implicit syntax."""
    value += b" " * (len(value) % 2)
    start = struct.pack("<HH", group, number)
    if not named:
        return start + struct.pack("<I", len(value)) + value
    if kind in (b"OW", b"SQ"):
        return start + kind + struct.pack("<HI", 0, len(value)) + value
    return start + kind + struct.pack("<H", len(value)) + value


def written(path, *, modality=b"CT", named=True, frames=1, more=b"", packed=b""):
    """Write an image of 20 rows of 16 tones, and return its path."""
    values = np.random.default_rng(0).integers(900, size=320 * frames, dtype="<i2").tobytes()
    syntax = packed or (b"1.2.840.10008.1.2.1\0" if named else b"1.2.840.10008.1.2\0")
    meta = element(2, 0x10, b"UI", syntax)
    short = struct.Struct("<H").pack
    rows = [
        (8, 0x60, b"CS", modality), (0x28, 2, b"US", short(1)), (0x28, 4, b"CS", b"MONOCHROME2"),
        (0x28, 8, b"IS", b"%d" % frames), (0x28, 0x10, b"US", short(20)),
        (0x28, 0x11, b"US", short(16)), (0x28, 0x30, b"DS", b"0.5\\0.5"),
        (0x28, 0x100, b"US", short(16)), (0x28, 0x101, b"US", short(16)),
        (0x28, 0x102, b"US", short(15)), (0x28, 0x103, b"US", short(1)),
        (0x28, 0x1052, b"DS", b"-100"), (0x28, 0x1053, b"DS", b"1"), (0x7FE0, 0x10, b"OW", values),
    ]  # fmt: skip
    body = b"".join(element(*row, named=named) for row in rows)
    length = element(2, 0, b"UL", struct.pack("<I", len(meta)))
    path.write_bytes(bytes(128) + b"DICM" + length + meta + more + body)
    return path


@pytest.mark.parametrize("named", [True, False])
def test_tomography_is_grey_in_hounsfield_units_and_millimetres(named, tmp_path):
    # A sequence without a length before the modality ends by marks.
    part = struct.pack("<HHI", 0xFFFE, 0xE000, 0xFFFFFFFF)
    part += element(8, 5, b"CS", b"ISO_IR 100")
    part += struct.pack("<HHIHHI", 0xFFFE, 0xE00D, 0, 0xFFFE, 0xE0DD, 0)
    more = struct.pack("<HH2sHI", 8, 6, b"SQ", 0, 0xFFFFFFFF) + part if named else b""
    path = written(tmp_path / "slice.dcm", named=named, more=more)
    mesh = vizlight.read(path)
    assert meaning.of(mesh).arrays["DICOMImage"]["units"] == "HU"
    assert georeference.unit_of(mesh) == "millimetre"
    look = vizlight.look(path, size=(300, 200))
    assert look.key[0]["title"].startswith("slice (HU)")
    picture = np.asarray(Image.open(look.save(tmp_path / "a.png")).convert("RGB")).astype(int)
    assert np.ptp(picture, axis=2).max() < 8


def test_tones_by_a_scale_are_grey_and_other_numbers_in_floating_point_are_not(tmp_path):
    path = written(tmp_path / "a.dcm", modality=b"MR")
    one, other = (element(0x28, 0x1053, b"DS", slope) for slope in (b"1", b"0.549"))
    path.write_bytes(path.read_bytes().replace(one, other))
    mesh = vizlight.read(path)
    assert vizlight.look(mesh).drawing.keys[0]["cmap"] == "gray"
    mesh["DICOMImage"] = np.random.default_rng(0).random(mesh.n_points)
    assert vizlight.look(mesh).drawing.keys[0]["cmap"] != "gray"


def test_the_bar_of_an_image_is_in_millimetres_and_it_has_no_north(tmp_path, monkeypatch):
    words, triangles = [], letters.triangles
    monkeypatch.setattr(letters, "triangles", lambda word: words.append(word) or triangles(word))
    frame = vizlight.cartography.frame(vizlight.read(written(tmp_path / "a.dcm")), letters=0.1)
    assert frame.n_cells
    assert {*words} == {"1 mm"}


def test_of_several_frames_the_first_is_noted_and_segments_are_no_tones(tmp_path):
    path = written(tmp_path / "tiles.dcm", modality=b"SEG", frames=3)
    said = meaning.of(vizlight.read(path))
    assert said.notes == ["the first of 3 frames, which may be tiles of one image"]
    assert not said.axes
    assert not vizlight.read(path).field_data.get("unit", [])


def test_packed_values_are_named_with_the_program_that_unpacks_them(tmp_path):
    path = written(tmp_path / "a.dcm", packed=b"1.2.840.10008.1.2.5\0")
    refused(path, "packed.*gdcmconv --raw 'a.dcm' 'a-raw.dcm'")
