"""Every bad input has its own message and exit code, and leaves nothing behind."""

import resource

from support import *

USAGE, INPUT = 2, 3


def limit_memory():
    """No input, however damaged, is a reason to ask for more than this."""
    resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))


def refuses(folder, shot, code, *parts, arguments=()):
    out = folder / "out"
    run = render(shot, out, *arguments, expect=code, preexec_fn=limit_memory)
    says(run, "ebru: error: ", *parts)
    assert "bug" not in run.stderr, run.stderr
    assert_nothing_written(out)


def truncate(path, share):
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * share)])


def test_missing_frame(folder):
    cache = write_cache(folder)
    (cache / "ball.0003.vdb").unlink()
    refuses(folder, write_cache_shot(folder), INPUT, "ball.####.vdb", "frames 3 are missing", "1-2,4")


def test_gap_before_or_just_after_the_frames_asked_for(folder):
    cache = write_cache(folder, frames=6)
    (cache / "ball.0002.vdb").rename(folder / "kept.vdb")
    refuses(folder, write_cache_shot(folder), INPUT, "ball.####.vdb", "frames 2 are missing", arguments=["--frames", "4"])
    (folder / "kept.vdb").rename(cache / "ball.0002.vdb")
    (cache / "ball.0005.vdb").unlink()
    refuses(folder, write_cache_shot(folder, method="quilt"), INPUT, "frames 5 are missing",
            arguments=["--frames", "2-3", "--set", "texture.look_ahead=2"])
    for arguments in (["--set", "texture.look_ahead=1"], ["--method", "particles"]):
        render(write_cache_shot(folder, method="quilt"), folder / "out", "--frames", "2-3", "--overwrite", *arguments)


def test_truncated_vdb(folder):
    for share, reason in ((0.0, "at byte 0"), (0.02, "ends at byte"), (0.5, "ends at byte"), (0.97, "ends at byte")):
        (folder / str(share)).mkdir()
        cache = write_cache(folder / str(share), frames=2)
        truncate(cache / "ball.0001.vdb", share)
        shot = write_cache_shot(folder / str(share), frames=2)
        refuses(folder / str(share), shot, INPUT, "ball.0001.vdb", reason)


def test_vdb_without_the_velocity_names_the_grids_it_has(folder):
    write_cache(folder, frames=2, frame_1=["--fault", "no_velocity"], frame_2=["--fault", "no_velocity"])
    refuses(folder, write_cache_shot(folder, 2), INPUT, "ball.0001.vdb", '"vel"', '"surface"')


def test_vdb_without_the_surface_names_the_grids_it_has(folder):
    write_cache(folder, frames=2, frame_1=["--fault", "no_surface"], frame_2=["--fault", "no_surface"])
    refuses(folder, write_cache_shot(folder, 2), INPUT, "ball.0001.vdb", '"surface"', '"vel"')


def test_velocity_that_is_not_finite(folder):
    for fault in ("nan", "inf"):
        (folder / fault).mkdir()
        write_cache(folder / fault, frames=2, frame_1=["--fault", fault])
        refuses(folder / fault, write_cache_shot(folder / fault, 2), INPUT, "ball.0001.vdb", fault)


def test_velocity_beyond_reason(folder):
    write_cache(folder, frames=2, frame_1=["--velocity", "1e9", "0", "0"])
    refuses(folder, write_cache_shot(folder, 2), INPUT, "ball.0001.vdb", "1e+09")


def test_empty_surface_renders_the_scene_without_fluid(folder):
    import exr

    write_cache(folder, frames=3, frame_2=["--fault", "empty"])
    out = folder / "out"
    render(write_cache_shot(folder, 3), out)
    masks = [exr.read(out / f"tiny.{f:04}.exr")[3]["texture.mask"] for f in (1, 2, 3)]
    assert any(masks[0]) and not any(masks[1]) and any(masks[2])


def test_surface_empty_in_every_frame(folder):
    write_cache(folder, frames=2, frame_1=["--fault", "empty"], frame_2=["--fault", "empty"])
    render(write_cache_shot(folder, 2), folder / "out")
    assert len(pictures(folder / "out")) == 2


def test_exemplar_missing(folder):
    refuses(folder, write_shot(folder, exemplar="nowhere.png"), INPUT, "nowhere.png")


def test_exemplar_of_zero_size(folder):
    (folder / "empty.png").write_bytes(b"")
    refuses(folder, write_shot(folder, exemplar="empty.png"), INPUT, "empty.png")


def test_exemplar_that_is_text(folder):
    (folder / "text.png").write_text("This is no picture.\n")
    refuses(folder, write_shot(folder, exemplar="text.png"), INPUT, "text.png")


def png(width, height):
    """A grey picture."""
    import struct
    import zlib

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = zlib.compress((b"\0" + b"\x80" * (3 * width)) * height)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", rows) + chunk(b"IEND", b""))


def test_exemplar_of_one_texel(folder):
    (folder / "dot.png").write_bytes(png(1, 1))
    for method in texture_methods():
        refuses(folder, write_shot(folder, method=method, exemplar="dot.png"), INPUT, "dot.png", "1 x 1")


def test_maps_that_do_not_fit_the_exemplars(folder):
    for name, size in (("a.png", 40), ("b.png", 40), ("c.png", 41)):
        (folder / name).write_bytes(png(size, 40))
    for method in texture_methods():
        shot = write_shot(folder, method=method, exemplar="a.png")
        two = ["--set", 'texture.exemplar=["a.png", "b.png"]']
        for key in ("height", "roughness", "alpha", "emission"):
            refuses(folder, shot, USAGE, f"texture.{key}: number of files: got 1, expected 2",
                    arguments=[*two, "--set", f"texture.{key}=a.png"])
            refuses(folder, shot, INPUT, f"c.png: size of the {key} map: got 41 x 40, expected 40 x 40", "b.png",
                    arguments=[*two, "--set", f'texture.{key}=["a.png", "c.png"]'])
        refuses(folder, shot, USAGE, "texture.weight_*", arguments=["--set", "texture.weight_colour=0"])
        refuses(folder, shot, USAGE, "texture.weight_alpha: got -1", arguments=["--set", "texture.weight_alpha=-1"])
        refuses(folder, shot, USAGE, "texture.exemplar is missing: an example image",
                arguments=["--set", "texture.exemplar=[]"])


def test_texel_size_zero(folder):
    refuses(folder, write_shot(folder, texel=0), USAGE, "tiny.toml:15: texture.texel_size: got 0 m, expected")


def test_texel_size_that_needs_more_than_memory(folder):
    for method in texture_methods():
        what = "places" if method == "erosion" else "particles"
        refuses(folder, write_shot(folder, method=method, texel="1e-9"), INPUT, "texture.texel_size", what)
    refuses(folder, write_shot(folder, method="erosion"), INPUT, "texture.erosion.radius: got 0.0001 texels", "triangles",
            arguments=["--set", "texture.erosion.radius=1e-4"])


def test_frames_outside_the_cache(folder):
    write_cache(folder)
    shot = write_cache_shot(folder)
    refuses(folder, shot, USAGE, "got 5-9 outside the cache", "1 to 4", arguments=["--frames", "2-9"])
    refuses(folder, shot, USAGE, "1 to 4", arguments=["--set", "shot.last_frame=99"])
    refuses(folder, shot, USAGE, "1 to 4", arguments=["--set", "shot.first_frame=0"])
    refuses(folder, shot, USAGE, "shot.first_frame = 3", arguments=["--set", "shot.first_frame=3", "--frames", "2"])


def test_frames_that_are_none(folder):
    refuses(folder, write_shot(folder), USAGE, '"1-x"', arguments=["--frames", "1-x"])
    refuses(folder, write_shot(folder), USAGE, "0/3", arguments=["--chunk", "0/3"])
    refuses(folder, write_shot(folder), USAGE, '"1-4y1"', "at least one frame", arguments=["--frames", "1-4y1"])
    says(ebru("inspect", write_shot(folder), "--frames", "1-4y1", expect=USAGE), '"1-4y1"', "at least one frame")


def test_no_cache_at_all(folder):
    refuses(folder, write_cache_shot(folder), INPUT, "ball.####.vdb")


def test_shot_with_many_mistakes(folder):
    shot = folder / "bad.toml"
    shot.write_text("[shot]\nfirst_fram = 1\n[texture]\ntexel_sise = 2\nexemplar = 3\n")
    refuses(folder, shot, USAGE, "4 problems", "bad.toml:2: ", "did you mean first_frame", "bad.toml:4: ",
            "did you mean texel_size", "bad.toml:5: texture.exemplar: got 3 (integer)", arguments=["--set", "a.b=1"])


def test_command_line(folder):
    for arguments in ([], ["rendr"], ["render"], ["render", "x.toml", "--spp", "many"], ["render", "x.toml", "--wat"]):
        says(ebru(*arguments, expect=USAGE), "ebru: error: ")
    says(ebru("render", folder / "nowhere.toml", expect=USAGE), "nowhere.toml: no such shot file")
    shot = write_shot(folder)
    refuses(folder, shot, USAGE, '--size: got "big"', arguments=["--size", "big"])
    refuses(folder, shot, USAGE, '--method syntesis: texture.method: got "syntesis"', "did you mean synthesis",
            arguments=["--method", "syntesis"])
    refuses(folder, shot, USAGE, "--size 0x360: camera.size: got", arguments=["--size", "0x360"])


main()
