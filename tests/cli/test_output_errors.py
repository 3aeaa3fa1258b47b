"""Results that cannot be written end the run with exit code 4, and what is there is whole."""

import resource
import shlex
import signal

from support import *

OUTPUT = 4


def test_output_folder_that_cannot_be(folder):
    shot = write_shot(folder, last=2)
    (folder / "file").write_text("in the way")
    run = render(shot, folder / "file/out", expect=OUTPUT)
    says(run, "file/out: cannot be written", "--out")
    run = render(shot, folder / "out", "--states", folder / "file", expect=OUTPUT)
    says(run, "file: cannot be written")
    assert_nothing_written(folder / "out")


def test_read_only_output_folder(folder):
    shot = write_shot(folder, last=2)
    if os.geteuid() == 0:
        # No permission stops root; a file system that takes no new files stops everybody.
        run = render(shot, "/proc/ebru", expect=OUTPUT)
        says(run, "/proc/ebru", "cannot be written")
        return
    (folder / "out").mkdir(mode=0o500)
    run = render(shot, folder / "out", expect=OUTPUT)
    says(run, "Permission denied")


def namespace_command():
    """A prefix under which mount works without leaving a trace, or None."""
    for prefix in (["unshare", "-m"], ["unshare", "-U", "-r", "-m"]):
        probe = subprocess.run([*prefix, "mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", "/mnt"],
                               capture_output=True) if shutil.which("unshare") else None
        if probe and probe.returncode == 0:
            return prefix
    return None


def run_on_small_disk(folder, shot, kilobytes, prefix):
    disk, copy = folder / "disk", folder / "copy"
    disk.mkdir()
    script = (f"mount -t tmpfs -o size={kilobytes}k tmpfs {shlex.quote(str(disk))} || exit 99; "
              f"{shlex.quote(EBRU)} render {shlex.quote(str(shot))} --out {shlex.quote(str(disk / 'out'))}; code=$?; "
              f"cp -a {shlex.quote(str(disk))} {shlex.quote(str(copy))}; exit $code")
    run = subprocess.run([*prefix, "sh", "-c", script], capture_output=True, text=True)
    return run, copy / "out"


def run_with_file_limit(folder, shot, kilobytes):
    """Where nothing can be mounted: files that may not grow fail in the same calls, with another reason."""

    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1024 * kilobytes, 1024 * kilobytes))

    run = subprocess.run([EBRU, "render", str(shot), "--out", str(folder / "out")], capture_output=True, text=True,
                         preexec_fn=limit)
    return run, folder / "out"


def test_full_disk(folder):
    shot = write_shot(folder)
    whole = folder / "whole"
    render(shot, whole)
    expected = files(whole)
    prefix = namespace_command()
    if prefix:
        kilobytes = sum(map(len, expected.values())) // 1024 // 2
        run, out = run_on_small_disk(folder, shot, kilobytes, prefix)
    else:
        kilobytes = max(map(len, pictures(whole).values())) // 1024 - 4
        run, out = run_with_file_limit(folder, shot, kilobytes)
    print(f"        {'tmpfs of' if prefix else 'files of at most'} {kilobytes} kB", flush=True)
    assert run.returncode == OUTPUT, (run.returncode, run.stderr)
    says(run, "cannot be written", "No space left on device" if prefix else "File too large")
    left = files(out)
    assert_no_temporaries(out)
    for name, content in left.items():
        assert name not in expected or content == expected[name], f"{name} is not whole"
    assert len(pictures(out)) < 8


main()
