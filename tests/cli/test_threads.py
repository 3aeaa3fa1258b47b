"""One thread and two give the same bits."""

import exr
from support import *


def test_pictures_and_states_do_not_depend_on_the_threads(folder):
    for method in texture_methods():
        shot = write_shot(folder, method=method, last=4)
        for threads in (1, 2):
            render(shot, folder / f"{method}{threads}", "--threads", threads, "--keep-states")
        assert_same_files(files(folder / f"{method}2"), files(folder / f"{method}1"), method)
        assert len(files(folder / f"{method}1/states")) == 4


def test_frames_that_overlap_are_those_made_one_by_one(folder):
    shot = write_shot(folder, method="synthesis", last=4)
    render(shot, folder / "overlapping", "--threads", "2", "--keep-states")
    render(shot, folder / "sequential", "--threads", "2", "--keep-states", "--sequential")
    assert_same_files(files(folder / "overlapping"), files(folder / "sequential"))


def test_these_shots_look_ahead(folder):
    """Without its look-ahead quilt lays other texture in the shot above, so what looks ahead has run there."""
    shot = write_shot(folder, method="quilt", last=4)
    render(shot, folder / "ahead", "--frames", "4")
    render(shot, folder / "blind", "--frames", "4", "--set", "texture.look_ahead=0")
    ahead, blind = (exr.read(folder / name / "tiny.0004.exr")[3]["texture.s"] for name in ("ahead", "blind"))
    assert ahead != blind


def test_caches_read_the_same(folder):
    write_cache(folder)
    shot = write_cache_shot(folder)
    for threads in (1, 2):
        render(shot, folder / f"out{threads}", "--threads", threads, "--keep-states")
    assert_same_files(files(folder / "out2"), files(folder / "out1"))


main()
