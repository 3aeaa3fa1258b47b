"""A shot gives the same files however its frames are split over runs, and a run never loses what is there."""

from support import *


def test_one_run_equals_a_run_and_its_continuation(folder):
    for method in texture_methods():
        shot = write_shot(folder, method=method)
        whole, parts = folder / f"{method}_whole", folder / f"{method}_parts"
        render(shot, whole)
        render(shot, parts, "--frames", "1-4")
        run = render(shot, parts, "--resume")
        says(run, "frames 1-4 are done already")
        assert_same_files(files(parts), files(whole), method)
        assert len(pictures(whole)) == 8
        assert sorted(files(whole / "states")) == ["tiny.0007.state", "tiny.0008.state"]


def test_resume_of_a_finished_shot_touches_nothing(folder):
    shot, out = write_shot(folder, last=3), folder / "out"
    render(shot, out)
    before = {p: p.stat().st_mtime_ns for p in out.rglob("*")}
    run = render(shot, out, "--resume")
    assert "0 frames" in run.stdout, run.stdout
    assert {p: p.stat().st_mtime_ns for p in out.rglob("*")} == before


def test_existing_frames_are_neither_lost_nor_made_again_by_default(folder):
    shot, out = write_shot(folder, last=3), folder / "out"
    render(shot, out, "--frames", "1-2")
    before = files(out)
    run = render(shot, out, expect=2)
    says(run, "frames 1-2 are there already", "--resume", "--overwrite")
    assert_same_files(files(out), before)
    ebru("render", shot, "--out", out, "--resume", "--overwrite", expect=2)


def test_resume_makes_again_what_is_damaged_foreign_or_gone(folder):
    shot, out = write_shot(folder, last=6), folder / "out"
    render(shot, out)
    good = files(out)
    second, third, fourth = (out / f"tiny.000{f}.exr" for f in (2, 3, 4))
    second.write_bytes(second.read_bytes()[:-200])
    third.unlink()
    render(shot, folder / "other", "--spp", "1", "--frames", "4")
    fourth.write_bytes((folder / "other/tiny.0004.exr").read_bytes())
    run = render(shot, out, "--resume")
    says(run, "frames 1,5-6 are done already")
    assert_same_files(pictures(out), {n: b for n, b in good.items() if n.endswith(".exr")})


def test_damaged_states_cost_time_only(folder):
    shot, whole, out = write_shot(folder, last=5), folder / "whole", folder / "out"
    render(shot, whole)
    render(shot, out, "--frames", "1-3")
    for state in (out / "states").iterdir():
        state.write_bytes(state.read_bytes()[:100])
    render(shot, out, "--resume")
    assert_same_files(pictures(out), pictures(whole))


def test_other_shots_states_are_not_used(folder):
    shot, whole, out = write_shot(folder, last=4), folder / "whole", folder / "out"
    changed = ["--set", "texture.texel_size=0.02"]
    render(shot, whole, *changed)
    render(shot, out, "--frames", "1-2")
    render(shot, out, "--resume", *changed)
    assert_same_files(pictures(out), pictures(whole))


def test_changed_shot_leaves_states_to_go_on_from(folder):
    shot, out = write_shot(folder, last=8), folder / "out"
    changed = ["--set", "texture.texel_size=0.02"]
    render(shot, out)
    render(shot, out, "--resume", *changed, "--frames", "1-4")
    run = ebru("synth", shot, "--out", out, "--resume", *changed, "--frames", "3-4")
    says(run, "frames 3-4 are done already")


def test_growing_cache_changes_the_frames_that_look_ahead(folder):
    for method, done in (("quilt", "frames 1-2 are done already"), ("particles", "frames 1-3 are done already")):
        there, later = folder / method, folder / f"{method}_later"
        there.mkdir(), later.mkdir()
        cache, whole, grown = write_cache(there, frames=6), there / "whole", there / "grown"
        ahead = ["--set", "texture.look_ahead=2"]
        shot = write_cache_shot(there, frames=4, method=method)
        render(shot, whole, *ahead)
        late = [cache / f"ball.000{f}.vdb" for f in (5, 6)]
        for file in late:
            file.rename(later / file.name)
        render(shot, grown, *ahead)
        for file in late:
            (later / file.name).rename(file)
        says(render(shot, grown, "--resume", *ahead), done)
        assert_same_files(pictures(grown), pictures(whole), method)


def test_resume_notices_that_a_map_changed(folder):
    exemplars = ROOT / "scenes/exemplars"
    for name in ("foam", "soup", "foam_height"):
        shutil.copy(exemplars / f"{name}.png", folder / f"{name}.png")
    maps = folder / "map.png"
    for key in ("exemplar", "height", "roughness", "alpha", "emission"):
        shutil.copy(exemplars / "foam_height.png", maps)
        shot, out = write_shot(folder, last=2, exemplar=folder / "foam.png"), folder / key
        files_of_key = ["foam.png", "map.png"] if key == "exemplar" else ["foam_height.png", "map.png"]
        settings = ["--set", 'texture.exemplar=["foam.png", "soup.png"]', "--set", f"texture.{key}={files_of_key}".replace("'", '"')]
        render(shot, out, *settings)
        assert "0 frames" in render(shot, out, "--resume", *settings).stdout
        before = pictures(out)
        shutil.copy(exemplars / "soup_height.png", maps)
        assert "2 frames" in render(shot, out, "--resume", *settings).stdout, key
        assert pictures(out) != before, key


def test_any_split_and_order_of_frames(folder):
    shot, whole = write_shot(folder, method="synthesis", last=7), folder / "whole"
    render(shot, whole)
    chunks = folder / "chunks"
    for i in (3, 1, 2):
        render(shot, chunks, "--chunk", f"{i}/3")
    assert_same_files(pictures(chunks), pictures(whole), "chunks")
    staggered = folder / "staggered"
    render(shot, staggered, "--frames", "1-7:3")
    assert_same_files(pictures(staggered), pictures(whole), "staggered")
    assert len(files(staggered / "states")) == 2
    render(shot, folder / "last", "--frames", "7")
    assert pictures(folder / "last")["tiny.0007.exr"] == pictures(whole)["tiny.0007.exr"]


def test_synth_then_render_from_its_states(folder):
    shot, whole = write_shot(folder, method="synthesis", last=5), folder / "whole"
    render(shot, whole, "--keep-states")
    ebru("synth", shot, "--out", folder / "synth", "--frames", "1-3")
    ebru("synth", shot, "--out", folder / "synth", "--resume")
    states = folder / "synth/states"
    assert_same_files(files(states), files(whole / "states"), "states")
    out = folder / "out"
    run = render(shot, out, "--states", states, "--frames", "2-5")
    assert "synthesis" not in run.stdout, run.stdout
    assert_same_files(pictures(out), {n: b for n, b in pictures(whole).items() if n != "tiny.0001.exr"})
    assert_same_files(files(states), files(whole / "states"), "states after rendering from them")
    run = ebru("synth", shot, "--out", folder / "synth", expect=2)
    says(run, "--resume", "--overwrite")


main()
