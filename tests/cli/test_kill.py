"""A run that is ended at any moment leaves whole files; the next --resume finishes and equals the undisturbed run."""

import signal
import time

from support import *


def start(shot, out):
    return subprocess.Popen([EBRU, "render", str(shot), "--out", str(out), "--resume"],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def wait_for(condition, process):
    """@return whether it came true while the process ran"""
    while process.poll() is None:
        if condition():
            return True
        time.sleep(0.002)
    return False


def count(out):
    """Pictures under their final names, while a run makes more."""
    return sum(".tmp." not in p.name for p in out.glob("*.exr"))


def whole_so_far(out, expected):
    """Every file under its final name is whole."""
    got = pictures(out)
    for name, content in got.items():
        assert content == expected[name], f"{name} is not whole"
    return got


def test_killed_runs_leave_whole_files_and_resume_to_the_same(folder):
    for method in texture_methods():
        shot, whole, out = write_shot(folder, method=method), folder / f"{method}_whole", folder / f"{method}_out"
        render(shot, whole)
        expected = pictures(whole)
        # Again and again in the same folder, each time a moment later after one more picture.
        for enough, delay in ((1, 0.0), (2, 0.01), (3, 0.03), (4, 0.06), (6, 0.1)):
            process = start(shot, out)
            wait_for(lambda: count(out) >= enough, process)
            time.sleep(delay)
            process.kill()
            process.communicate()
            whole_so_far(out, expected)
        render(shot, out, "--resume")
        assert_same_files(pictures(out), expected, method)
        assert_no_temporaries(out)


def test_temporaries_of_a_killed_run_are_removed(folder):
    shot, out = write_shot(folder), folder / "out"
    process = start(shot, out)
    wait_for(lambda: any(".tmp." in p.name for p in out.rglob("*")), process)
    process.kill()
    process.communicate()
    render(shot, out, "--resume")
    assert_no_temporaries(out)
    assert len(pictures(out)) == 8


def test_interrupted_runs_end_cleanly(folder):
    for number in (signal.SIGINT, signal.SIGTERM):
        shot, whole, out = write_shot(folder), folder / f"whole{number}", folder / f"out{number}"
        render(shot, whole)
        process = start(shot, out)
        assert wait_for(lambda: count(out) >= 2, process)
        process.send_signal(number)
        _, messages = process.communicate()
        assert process.returncode == 130, (process.returncode, messages)
        assert "--resume" in messages, messages
        assert_no_temporaries(out)
        assert 2 <= len(whole_so_far(out, pictures(whole))) < 8
        render(shot, out, "--resume")
        assert_same_files(files(out), files(whole))


main()
