"""[output] of the shot file: compression of the pictures, and previews that can be made again without rendering."""

import exr
from support import *

OCIO = """ocio_profile_version: 2
roles: {default: raw, scene_linear: raw}
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  Monitor:
    - !<View> {name: Plain, colorspace: raw}
    - !<View> {name: Dark, colorspace: dark}
active_displays: [Monitor]
active_views: [Plain, Dark]
colorspaces:
  - !<ColorSpace> {name: raw}
  - !<ColorSpace>
    name: dark
    from_scene_reference: !<MatrixTransform> {matrix: [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]}
"""


def environment(**variables):
    """Whatever OCIO the tests are run under must not count."""
    return {**{k: v for k, v in os.environ.items() if k != "OCIO"}, **variables}


def png(path):
    """@return width, height, channels, list of rows of bytes; of what zlib and PNG's filters make of 8-bit pictures"""
    import struct
    import zlib

    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[at + 8 : at + 18])
        if kind == b"IDAT":
            packed += data[at + 8 : at + 8 + size]
        at += size + 12
    assert depth == 8 and colour in (2, 6)
    channels = {2: 3, 6: 4}[colour]
    raw, rows, stride = zlib.decompress(packed), [], width * channels
    before = bytes(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for i in range(stride):
            left = line[i - channels] if i >= channels else 0
            corner = before[i - channels] if i >= channels else 0
            up, guess = before[i], left + before[i] - corner
            nearest = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            line[i] = (line[i] + (0, left, up, (left + up) // 2, nearest)[kind]) & 255
        rows.append(bytes(line))
        before = bytes(line)
    return width, height, channels, rows


def mean(path):
    rows = png(path)[3]
    return sum(map(sum, rows)) / sum(map(len, rows))


def test_previews_are_made_again_without_rendering(folder):
    shot, out = write_shot(folder, last=2), folder / "out"
    render(shot, out, "--preview", env=environment())
    frames, first = pictures(out), files(out / "preview")
    run = ebru("preview", shot, "--out", out, "--set", "output.exposure=1.5", env=environment())
    assert "2 previews" in run.stdout and "preview/tiny.####.png" in run.stdout, run.stdout
    assert_same_files(pictures(out), frames)
    brighter = files(out / "preview")
    assert brighter.keys() == first.keys() and all(brighter[name] != first[name] for name in first)
    before = mean(out / "preview/tiny.0001.png")
    ebru("preview", shot, "--out", out, env=environment())
    assert_same_files(files(out / "preview"), first, "the first settings again")
    assert mean(out / "preview/tiny.0001.png") < before
    (out / "preview/tiny.0001.png").unlink()
    ebru("preview", shot, "--out", out, "--frames", "1", "--threads", "1", env=environment())
    assert_same_files(files(out / "preview"), first, "one frame, one thread")
    if shutil.which("ffmpeg"):
        assert (out / "tiny.mp4").exists()


def test_previews_of_lossy_pictures_show_what_is_stored(folder):
    shot, out, lossy = write_shot(folder, last=1), folder / "out", ["--set", "output.compression=dwaa", "--set", "output.dwa_level=2000"]
    render(shot, out, "--preview", *lossy, env=environment())
    first = files(out / "preview")
    ebru("preview", shot, "--out", out, env=environment())
    again = {name: png(out / "preview" / name)[3] for name in first}
    ebru("preview", shot, "--out", out, *lossy, env=environment())
    assert_same_files(files(out / "preview"), first)
    assert {name: png(out / "preview" / name)[3] for name in first} == again


def test_preview_needs_pictures_and_nothing_else(folder):
    write_cache(folder, frames=3)
    shot, out = write_cache_shot(folder, frames=3), folder / "out"
    says(ebru("preview", shot, "--out", out, expect=3), "tiny.####.exr", "frames 1-3", "--out")
    assert not out.exists()
    render(shot, out, "--frames", "2")
    shutil.rmtree(folder / "cache")
    ebru("preview", shot, "--out", out, env=environment())
    assert sorted(files(out / "preview")) == ["tiny.0002.png"]
    says(ebru("preview", shot, "--out", out, "--frames", "1-3", expect=3), "frames 1,3")
    (out / "tiny.0002.exr").write_bytes((out / "tiny.0002.exr").read_bytes()[:-100])
    says(ebru("preview", shot, "--out", out, expect=3), "tiny.0002.exr")


def test_view_changes_previews_and_not_pictures(folder):
    shot, out = write_shot(folder, last=2), folder / "out"
    render(shot, out, "--preview", env=environment())
    first, frames = files(out / "preview"), pictures(out)
    run = render(shot, out, "--resume", "--preview", "--set", "output.view=srgb", env=environment())
    says(run, "frames 1-2 are done already")
    assert "0 frames" in run.stdout
    assert_same_files(pictures(out), frames)
    clipped = files(out / "preview")
    assert all(clipped[name] != first[name] for name in first)
    stamps = {p: p.stat().st_mtime_ns for p in (out / "preview").iterdir()}
    render(shot, out, "--resume", "--preview", "--set", "output.view=srgb", env=environment())
    assert {p: p.stat().st_mtime_ns for p in (out / "preview").iterdir()} == stamps, "nothing changed, nothing made"
    (out / "preview/tiny.0002.png").unlink()
    render(shot, out, "--resume", "--preview", "--set", "output.view=srgb", env=environment())
    assert_same_files(files(out / "preview"), clipped, "a missing one is made again")


def test_transparent_previews_have_alpha(folder):
    shot, out = write_shot(folder, last=1), folder / "out"
    shot.write_text(shot.read_text().replace("enabled = true", "enabled = false"))
    render(shot, out, "--preview", "--set", "output.transparent=true", env=environment())
    width, height, channels, rows = png(out / "preview/tiny.0001.png")
    assert (width, height, channels) == (48, 32, 4)
    alpha = [row[i] for row in rows for i in range(3, len(row), 4)]
    assert min(alpha) == 0 and max(alpha) == 255 and any(0 < a < 255 for a in alpha)
    if shutil.which("ffmpeg"):
        assert (out / "tiny.mp4").stat().st_size > 300


def test_opencolorio(folder):
    shot, out, config = write_shot(folder, last=1), folder / "out", folder / "config.ocio"
    config.write_text(OCIO)
    dark = ["--set", "output.ocio_view=Dark"]
    render(shot, out, "--preview", "--set", "output.ocio_config=config.ocio", *dark, env=environment())
    assert mean(out / "preview/tiny.0001.png") == 0.0, "the path is seen from the shot file, and the view is used"
    ebru("preview", shot, "--out", out, *dark, env=environment())
    assert mean(out / "preview/tiny.0001.png") > 0.0, "no configuration"
    ebru("preview", shot, "--out", out, *dark, env=environment(OCIO=str(config)))
    assert mean(out / "preview/tiny.0001.png") == 0.0, "the environment's"
    ebru("preview", shot, "--out", out, "--set", "output.view=filmic", *dark, env=environment(OCIO=str(config)))
    assert mean(out / "preview/tiny.0001.png") > 0.0, "filmic wins over the environment"


def test_wrong_views_are_found_before_rendering(folder):
    shot, out, config = write_shot(folder, last=1), folder / "out", folder / "config.ocio"
    config.write_text(OCIO)
    use = ["--preview", "--set", "output.ocio_config=config.ocio"]
    says(render(shot, out, *use, "--set", "output.ocio_view=Bright", expect=2), "output.ocio_view", '"Bright"', "Plain, Dark")
    says(render(shot, out, *use, "--set", "output.ocio_display=TV", expect=2), "output.ocio_display", '"TV"', "Monitor")
    says(render(shot, out, "--preview", "--set", "output.view=ocio", expect=2, env=environment()), "output.ocio_config")
    says(render(shot, out, "--preview", "--set", "output.view=filmc", expect=2), "output.view", "filmic")
    config.write_text("These are words.\n")
    says(render(shot, out, *use, expect=3), "config.ocio", "OpenColorIO")
    assert_nothing_written(out)


def test_compression_decides_files_and_not_data(folder):
    shot = write_shot(folder, last=1)
    planes, sizes = {}, {}
    for name in ("none", "zips", "zip", "piz", "dwaa", "dwab"):
        out = folder / name
        render(shot, out, "--set", f"output.compression={name}")
        path = out / "tiny.0001.exr"
        sizes[name] = path.stat().st_size
        if name in ("none", "zips", "zip"):
            planes[name] = exr.read(path)[3]
        run = render(shot, out, "--set", f"output.compression={name}", "--resume")
        assert "0 frames" in run.stdout, f"{name}: {run.stdout}"
    assert planes["zip"] == planes["zips"] == planes["none"]
    assert all(sizes[name] < sizes["none"] for name in sizes if name != "none"), sizes
    says(render(shot, folder / "zip", "--set", "output.compression=b44", expect=2), "output.compression", "dwaa")


main()
