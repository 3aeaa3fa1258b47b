"""The subcommands beside rendering."""

import struct

from support import *


def test_version_help_and_methods(folder):
    assert ebru("--version").stdout.startswith("ebru ")
    for command in ("render", "synth", "preview", "export", "inspect"):
        assert "--set" in ebru(command, "--help").stdout
    # The tests that run every method take their list from the program: here it is checked.
    assert sorted(methods()) == ["erosion", "particles", "plain", "quilt", "synthesis"], methods()


def test_reference_of_the_shot_file_is_the_programs(folder):
    text = (ROOT / "docs/shot-file.md").read_text()
    begin, end = "<!-- ebru options -->\n", "<!-- end of ebru options -->"
    documented = text[text.index(begin) + len(begin) : text.index(end)]
    assert documented == ebru("options").stdout, "docs/shot-file.md is old: put the output of `ebru options` there"


def test_shipped_shots_are_right(folder):
    shots = sorted((ROOT / "scenes").glob("*.toml"))
    assert len(shots) >= 4
    for shot in shots:
        assert f"shot {shot.stem}: frames 1 to " in ebru("inspect", shot, "--frames", "1").stdout


def test_inspect_of_caches(folder):
    cache = write_cache(folder)
    for name in (cache / "ball.####.vdb", cache / "ball.0002.vdb", write_cache_shot(folder)):
        text = ebru("inspect", name).stdout
        assert "surface" in text and "vel" in text and "velocity check" in text, text
    says(ebru("inspect", cache / "ball.0009.vdb", expect=3), "ball.0009.vdb")
    (cache / "text.0001.vdb").write_text("This is no VDB.\n")
    says(ebru("inspect", cache / "text.0001.vdb", expect=3), "text.0001.vdb")
    says(ebru("inspect", cache / "ball.####.vdb", "--set", "texture.method=x", expect=2), "[fluid] alone")


def test_inspect_says_what_the_exemplars_have(folder):
    exemplars = ROOT / "scenes/exemplars"
    lists = {"exemplar": ["foam", "soup"], "height": ["foam_height", "soup_height"], "roughness": ["soup_height", "foam_height"]}
    settings = []
    for key, names in lists.items():
        files_of_key = ", ".join(f'"{exemplars / name}.png"' for name in names)
        settings += ["--set", f"texture.{key}=[{files_of_key}]"]
    text = ebru("inspect", write_shot(folder), *settings).stdout
    assert "foam.png, 256 x 256 texels" in text and "soup.png, 256 x 256 texels" in text, text
    assert "maps: colour, height, roughness; synthesised from 4 components" in text and "features of about" in text, text
    text = ebru("inspect", write_shot(folder)).stdout
    assert "maps: colour; synthesised as they are" in text, text


def test_preview_and_movie(folder):
    shot, out = write_shot(folder, last=3), folder / "out"
    run = render(shot, out, "--preview", "--frames", "1-2")
    previews = files(out / "preview")
    assert sorted(previews) == ["tiny.0001.png", "tiny.0002.png"]
    assert all(data.startswith(b"\x89PNG") for data in previews.values())
    if shutil.which("ffmpeg"):
        assert (out / "tiny.mp4").stat().st_size > 500
        assert "tiny.mp4" in run.stdout


def movie_frames(movie):
    run = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames",
                          "-of", "csv=p=0", movie], capture_output=True, text=True, check=True)
    return int(run.stdout.strip().strip(","))


def test_movie_is_of_all_frames_whichever_a_run_is_over(folder):
    if not shutil.which("ffprobe"):
        return
    shot, out = write_shot(folder, last=4), folder / "out"
    movie = out / "tiny.mp4"
    render(shot, out, "--preview", "--frames", "1-3")
    assert movie_frames(movie) == 3
    render(shot, out, "--preview", "--frames", "2", "--overwrite")
    assert movie_frames(movie) == 3
    render(shot, out, "--preview", "--frames", "4")
    assert movie_frames(movie) == 4
    ebru("preview", shot, "--out", out, "--frames", "3")
    assert movie_frames(movie) == 4
    # One of another picture, and three of another view.
    render(shot, out, "--frames", "4", "--overwrite", "--spp", "1")
    ebru("preview", shot, "--out", out, "--frames", "3")
    assert movie_frames(movie) == 3
    ebru("preview", shot, "--out", out, "--frames", "3", "--set", "output.exposure=1")
    assert movie_frames(movie) == 1


def test_shares_of_the_phases_add_up(folder):
    lines = render(write_shot(folder, last=3), folder / "out", "--preview").stdout.splitlines()
    begin = next(i for i, line in enumerate(lines) if line.startswith("phase"))
    end = next(i for i, line in enumerate(lines) if line.startswith("all "))
    seconds = {line[:20].strip(): float(line.split()[-2]) for line in lines[begin + 1 : end + 1]}
    total = seconds.pop("all")
    assert "check velocity" in seconds, seconds
    assert abs(sum(seconds.values()) - total) <= 0.01 * len(seconds), (seconds, total)


def test_run_without_ffmpeg_keeps_the_frames(folder):
    shot, out = write_shot(folder, last=2), folder / "out"
    run = render(shot, out, "--preview", env={**os.environ, "PATH": "/nonexistent"})
    says(run, "no movie: ffmpeg is not installed; the frames are complete")
    assert len(pictures(out)) == 2 and len(files(out / "preview")) == 2
    assert not (out / "tiny.mp4").exists()


def test_export(folder):
    shot, out = write_shot(folder, last=2), folder / "out"
    ebru("export", shot, "--out", out)
    data = (out / "geometry/tiny.0002.ply").read_bytes()
    header, body = data.split(b"end_header\n", 1)
    lines = header.decode().split("\n")
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"]
    vertices = int(next(line for line in lines if line.startswith("element vertex")).split()[2])
    faces = int(next(line for line in lines if line.startswith("element face")).split()[2])
    record = struct.Struct("<8f3B3f")
    assert vertices > 100 and len(body) == vertices * record.size + faces * 13
    moving, colours = 0, set()
    for vertex in record.iter_unpack(body[: vertices * record.size]):
        assert abs(sum(n * n for n in vertex[3:6]) - 1.0) < 1e-3
        assert all(0.0 <= c <= 1.0 for c in vertex[6:8]), vertex[6:8]
        colours.add(vertex[8:11])
        moving += any(vertex[11:14])
    assert moving > vertices // 2 and len(colours) > 5
    for face in struct.iter_unpack("<B3i", body[vertices * record.size :]):
        assert face[0] == 3 and all(0 <= v < vertices for v in face[1:])
    assert "0 surfaces" in ebru("export", shot, "--out", out, "--resume").stdout
    ebru("export", shot, "--out", out, expect=2)


def test_fluid_that_moves_faster_than_its_surface_is_warned_of(folder):
    write_cache(folder, frames=4, **{f"frame_{f}": ["--centre", str(0.05 * f), "--velocity", "0.05", "0", "0"]
                                     for f in range(1, 5)})
    run = render(write_cache_shot(folder), folder / "out")
    says(run, "warning", "velocity check", "fluid.velocity_scale")


main()
