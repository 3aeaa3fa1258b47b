"""Caches of PLY meshes: rendered, inspected, told apart, and refused with a reason."""

import math
import struct

from support import *

USAGE, INPUT = 2, 3


def ball(centre, velocity, radius=0.2, rings=16, names=("vx", "vy", "vz")):
    """A sphere as a binary PLY."""
    vertices, faces, segments = [], [], 2 * rings
    for r in range(rings + 1):
        for s in range(segments):
            theta, phi = math.pi * r / rings, 2 * math.pi * s / segments
            vertices.append((centre[0] + radius * math.sin(theta) * math.cos(phi),
                             centre[1] + radius * math.sin(theta) * math.sin(phi), centre[2] + radius * math.cos(theta)))
    for r in range(rings):
        for s in range(segments):
            a, b = r * segments + s, r * segments + (s + 1) % segments
            faces.append((a, a + segments, b + segments, b))
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {name}" for name in ("x", "y", "z", *names)]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    return ("\n".join(header).encode() + b"".join(struct.pack("<6f", *v, *velocity) for v in vertices)
            + b"".join(struct.pack("<B4i", 4, *f) for f in faces))


def write_meshes(folder, frames=4):
    cache = folder / "cache"
    cache.mkdir()
    for frame in range(1, frames + 1):
        (cache / f"ball.{frame:04}.ply").write_bytes(ball((0.02 * frame, 0, 0), (0.48, 0, 0)))
    return cache


def mesh_shot(folder, frames=4, path="cache/ball.####.ply", **options):
    options = {"position": "[0, -1.5, 0.4]", "target": "[0, 0, 0]", "ground": -0.3, "texel": 0.02, **options}
    return write_shot(folder, f'source = "mesh"\npath = "{path}"\nperiod_frames = 5', last=frames, **options)


def refuses(folder, shot, code, *parts):
    says(render(shot, folder / "out", expect=code), "ebru: error: ", *parts)
    assert_nothing_written(folder / "out")


def test_inspect(folder):
    cache = write_meshes(folder)
    for name in (mesh_shot(folder), cache / "ball.####.ply", cache / "ball.0002.ply"):
        text = ebru("inspect", name).stdout
        for part in ("PLY, binary_little_endian: vertex (544: x y z vx vy vz)", "frames 1 to 4, 4 of 4 there", "velocity check"):
            assert part in text, text
    assert "s = 1.0" in ebru("inspect", cache / "ball.####.ply").stdout
    (cache / "one.ply").write_bytes(ball((0, 0, 0), (0, 0, 0)))
    assert "frames 1 to 48, a still surface in a steady flow" in ebru("inspect", cache / "one.ply").stdout


def test_motion_is_the_meshs(folder):
    import exr

    write_meshes(folder)
    out = folder / "out"
    for method in ("particles", "quilt"):
        render(mesh_shot(folder, method=method), out, "--overwrite")
        channels = exr.read(out / "tiny.0002.exr")[3]
        fluid = [i for i, mask in enumerate(channels["texture.mask"]) if mask]
        assert len(fluid) > 100
        assert all(abs(channels["velocity.X"][i] - 0.48) < 1e-3 for i in fluid)
        assert sum(channels["forward.u"][i] > 0.3 for i in fluid) == len(fluid)


def test_threads_and_resume_give_the_same(folder):
    write_meshes(folder)
    shot = mesh_shot(folder)
    render(shot, folder / "one", "--threads", "1")
    render(shot, folder / "two", "--threads", "2", "--frames", "1-2")
    render(shot, folder / "two", "--threads", "2", "--resume")
    assert_same_files(pictures(folder / "two"), pictures(folder / "one"))


def test_other_velocities_in_files_of_the_same_size_are_noticed(folder):
    cache = write_meshes(folder)
    shot, out = mesh_shot(folder), folder / "out"
    render(shot, out)
    assert "0 frames" in render(shot, out, "--resume").stdout
    (cache / "ball.0003.ply").write_bytes(ball((0.06, 0, 0), (0.4, 0, 0)))
    before = pictures(out)
    render(shot, out, "--resume")
    after = pictures(out)
    assert before["tiny.0001.exr"] == after["tiny.0001.exr"]
    assert before["tiny.0003.exr"] != after["tiny.0003.exr"]


def test_one_file_is_a_steady_flow(folder):
    (folder / "ball.ply").write_bytes(ball((0, 0, 0), (0, 0, 0)))
    shot = mesh_shot(folder, frames=5, path="ball.ply")
    render(shot, folder / "out")
    assert len(pictures(folder / "out")) == 5
    refuses(folder / "more", mesh_shot(folder, frames=6, path="ball.ply"), USAGE, "1 to 5")


def test_an_empty_mesh_is_a_frame_without_fluid(folder):
    import exr

    cache = write_meshes(folder, frames=3)
    (cache / "ball.0002.ply").write_text("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nelement face 0\n"
                                         "property list uchar int vertex_indices\nend_header\n")
    render(mesh_shot(folder, 3), folder / "out")
    masks = [exr.read(folder / f"out/tiny.{f:04}.exr")[3]["texture.mask"] for f in (1, 2, 3)]
    assert any(masks[0]) and not any(masks[1]) and any(masks[2])


def test_missing_frame_and_missing_cache(folder):
    cache = write_meshes(folder)
    (cache / "ball.0003.ply").unlink()
    refuses(folder, mesh_shot(folder), INPUT, "ball.####.ply", "frames 3 are missing", "1-2,4")
    refuses(folder, mesh_shot(folder, path="cache/sea.####.ply"), INPUT, "sea.####.ply")
    refuses(folder, mesh_shot(folder, path=""), USAGE, "fluid.path", ".ply")


def test_bad_files(folder):
    whole = ball((0.02, 0, 0), (0.48, 0, 0))
    bad = {"magic": (b"solid\n", ("magic",)), "cut": (whole[: len(whole) // 2], ("element \"vertex\"", "cut off")),
           "still": (ball((0, 0, 0), (0, 0, 0), names=("u", "v", "w")), ("velocity of the vertices", "x y z u v w", "vx vy vz")),
           "nan": (ball((0, 0, 0), (math.nan, 0, 0)), ("\"vx\"", "nan")), "fast": (ball((0, 0, 0), (1e6, 0, 0)), ("1e+06",))}
    for name, (content, parts) in bad.items():
        (folder / name).mkdir()
        cache = write_meshes(folder / name, frames=2)
        (cache / "ball.0001.ply").write_bytes(content)
        refuses(folder / name, mesh_shot(folder / name, 2), INPUT, "ball.0001.ply: ", *parts)


main()
