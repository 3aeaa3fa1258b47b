"""`ebru export --atlas`: the picture, the coordinates of the surface in it, and when both are made again."""

import math
import re
import struct

import exr
from support import *

VERTEX = struct.Struct("<8f3B3f")
FACE = struct.Struct("<B3iB6f")
FOAM = ROOT / "scenes/exemplars/foam.png"
CHANNELS = {"R", "G", "B", "A", "displacement"}


def export(shot, out, *arguments, **options):
    return ebru("export", shot, "--out", out, *arguments, **options)


def read_ply(path):
    """@return (lines of the header, vertices, faces) of a surface with atlas coordinates"""
    header, body = path.read_bytes().split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    vertices = int(next(line for line in lines if line.startswith("element vertex")).split()[2])
    faces = int(next(line for line in lines if line.startswith("element face")).split()[2])
    assert len(body) == vertices * VERTEX.size + faces * FACE.size
    middle = vertices * VERTEX.size
    return lines, list(VERTEX.iter_unpack(body[:middle])), list(FACE.iter_unpack(body[middle:]))


def linear(srgb8):
    c = srgb8 / 255
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def bilinear(plane, width, height, u, v):
    """v is up: row 0, the upper one, has the largest v."""
    x, y = u * width - 0.5, (1 - v) * height - 0.5
    left, top = math.floor(x), math.floor(y)
    value = 0.0
    for row, down in ((top, 1 - (y - top)), (top + 1, y - top)):
        for column, right in ((left, 1 - (x - left)), (left + 1, x - left)):
            value += down * right * plane[row * width + column]
    return value


def test_atlas_shows_what_the_vertices_show(folder):
    # Where charts of `particles` meet it squeezes the exemplar into less than a texel of the atlas.
    for method, size, mean_most, most in (("particles", "192x256", 0.04, 0.5), ("quilt", "256x192", 0.006, 0.03)):
        shot, out = write_shot(folder, method=method, last=2, exemplar=FOAM), folder / method
        export(shot, out, "--frames", "2", "--atlas", size)
        assert sorted(files(out / "geometry")) == ["tiny.0002.atlas.exr", "tiny.0002.ply"]
        lines, vertices, faces = read_ply(out / "geometry/tiny.0002.ply")
        assert "comment TextureFile tiny.0002.atlas.exr" in lines and "property list uchar float texcoord" in lines
        header, width, height, planes = exr.read(out / "geometry/tiny.0002.atlas.exr")
        assert f"{width}x{height}" == size and set(planes) == CHANNELS
        assert all(math.isfinite(value) for plane in planes.values() for value in plane)
        assert exr.text_attribute(header, "ebru:fingerprint") in "\n".join(lines)
        assert 0.001 < struct.unpack("<f", header["ebru:atlasTexelSizeWorld"][1])[0] < 0.02
        assert set(planes["A"]) == {0.0, 1.0} and sum(planes["A"]) > 0.5 * width * height
        errors = []
        for face in faces:
            assert face[0] == 3 and face[4] == 6
            for corner in range(3):
                u, v = face[5 + 2 * corner : 7 + 2 * corner]
                assert 0.0 <= u <= 1.0 and 0.0 <= v <= 1.0
                assert abs(bilinear(planes["A"], width, height, u, v) - 1) < 1e-6, "a filter reads what is no surface"
                colour = vertices[face[1 + corner]][8:11]
                errors += [abs(bilinear(planes[c], width, height, u, v) - linear(colour[k])) for k, c in enumerate("RGB")]
        errors.sort()
        mean, of_99_in_100 = sum(errors) / len(errors), errors[int(0.99 * len(errors))]
        assert mean < mean_most and of_99_in_100 < most, (method, mean, of_99_in_100)


def test_atlas_has_the_height_of_the_exemplar(folder):
    shot, out = write_shot(folder, last=1, exemplar=FOAM), folder / "out"
    height = ROOT / "scenes/exemplars/foam_height.png"
    export(shot, out, "--atlas", "64x64", "--set", f'texture.height=["{height}"]')
    _, _, _, planes = exr.read(out / "geometry/tiny.0001.atlas.exr")
    heights = [h for h, a in zip(planes["displacement"], planes["A"]) if a > 0]
    assert 0 <= min(heights) < max(heights) <= 1 and max(heights) - min(heights) > 0.1


def test_surface_without_an_atlas_is_as_before(folder):
    shot = write_shot(folder, last=1)
    export(shot, folder / "plain")
    export(shot, folder / "atlas", "--atlas", "128x128")
    assert sorted(files(folder / "plain/geometry")) == ["tiny.0001.ply"]
    plain = (folder / "plain/geometry/tiny.0001.ply").read_bytes()
    assert b"texcoord" not in plain and b"TextureFile" not in plain
    _, vertices, faces = read_ply(folder / "atlas/geometry/tiny.0001.ply")
    body = plain.split(b"end_header\n", 1)[1]
    assert body == b"".join(VERTEX.pack(*v) for v in vertices) + b"".join(struct.pack("<B3i", *f[:4]) for f in faces)


def test_resume_makes_again_what_is_not_whole_or_of_another_size(folder):
    shot, out = write_shot(folder, last=2), folder / "out"
    size = ["--atlas", "128x96"]
    export(shot, out, *size, "--threads", "1")
    good = files(out / "geometry")
    assert len(good) == 4
    assert "0 surfaces" in export(shot, out, *size, "--resume").stdout
    says(export(shot, out, *size, expect=2), "frames 1-2 are there already", "--resume", "--overwrite")

    atlas, surface = out / "geometry/tiny.0001.atlas.exr", out / "geometry/tiny.0001.ply"
    for spoil in (atlas.unlink, surface.unlink, lambda: atlas.write_bytes(good[atlas.name][:-100])):
        spoil()
        assert "1 surface in" in export(shot, out, *size, "--resume", "--threads", "3").stdout
        assert_same_files(files(out / "geometry"), good)
    surface.unlink()
    says(export(shot, out, *size, "--frames", "1", expect=2), "frames 1 are there already")

    assert "2 surfaces" in export(shot, out, "--atlas", "96x128", "--resume").stdout
    assert files(out / "geometry") != good
    assert "2 surfaces" in export(shot, out, "--resume").stdout
    assert b"texcoord" not in surface.read_bytes()
    assert_no_temporaries(out)


def test_frames_without_fluid_have_an_empty_atlas(folder):
    write_cache(folder, frames=2, frame_1=["--fault", "empty"])
    shot, out = write_cache_shot(folder, frames=2), folder / "out"
    export(shot, out, "--atlas", "16x16", "--frames", "1")
    _, vertices, faces = read_ply(out / "geometry/tiny.0001.ply")
    assert not vertices and not faces
    _, width, height, planes = exr.read(out / "geometry/tiny.0001.atlas.exr")
    assert (width, height) == (16, 16) and not any(any(plane) for plane in planes.values())


def test_bad_sizes(folder):
    shot, out = write_shot(folder, last=1), folder / "out"
    for size in ("0x64", "64x0", "64", "64x", "-64x64", "64x64x64", "64 x 64", "16385x64", "64x99999999", "1e3x64"):
        run = export(shot, out, f"--atlas={size}", expect=2)
        says(run, f'--atlas: size: got "{size}", expected WIDTHxHEIGHT, both from 1 to 16384')
    assert_nothing_written(out)
    run = export(shot, out, "--atlas", "12x12", expect=2)
    says(run, "frame 1: atlas: got ", " charts", "12 x 12 texels", "expected at least", "--atlas ")
    assert not files(out / "geometry")
    advice = re.search(r"--atlas (\d+x\d+)", run.stderr).group(1)
    export(shot, out, "--atlas", advice, "--overwrite")


main()
