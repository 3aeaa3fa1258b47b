#!/usr/bin/python3
"""Renders a shot with several texture methods, judges each and lays them side by side.

    scripts/compare.py dam_break --methods particles,synthesis
    scripts/compare.py scenes/dam_break.toml --methods particles,synthesis --frames 1-12 --size 320x180 --out /tmp/compared

Writes OUT/METHOD/ (frames, metrics.json, report.html), OUT/comparison.json and OUT/comparison.html, and a table to the
terminal. Frames that are there already are kept when they are of this shot (`ebru render --resume`). Only the frames asked
for are judged; others that lie in the folder are left out.
Exit code: 0, 2 usage, 3 input, 4 output, else that of ebru.
"""

import argparse
import concurrent.futures
import os
import pathlib
import subprocess
import sys

import requirements

requirements.provide()

from evaluation import command, comparison_report, frames, report, sequence, shot, terminal_table
from evaluation.errors import UsageError
from evaluation.frame_item import item_of

CORES_PER_RENDER = 4  # as many as one render keeps busy
STRIP_FRAMES = 8


def parse():
    lines = __doc__.strip().split("\n\n")
    parser = argparse.ArgumentParser(description=lines[0], epilog="\n\n".join(lines[1:]),
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shot", help="shot file or name of one of scenes/")
    parser.add_argument("--methods", required=True, help="names, with commas; see `ebru methods`")
    parser.add_argument("--frames", help="as for `ebru render` (default: all of the shot)")
    parser.add_argument("--size", help="WxH of the pictures (default: the shot's)")
    parser.add_argument("--spp", type=int, help="samples per pixel (default: the shot's)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="any option of the shot")
    parser.add_argument("--out", type=pathlib.Path, help="folder of it all (default: out/SHOT_comparison)")
    parser.add_argument("--ebru", type=pathlib.Path, help="the program (default: built first, as scripts/render does)")
    command.add_metric_arguments(parser)
    return parser.parse_args()


def built_ebru():
    """@return the release build, brought up to date"""
    run = subprocess.run(["bash", "-c", ". scripts/common.sh && scripts/setup --for render && build release OFF ebru"],
                         cwd=command.ROOT, stdout=sys.stderr)
    if run.returncode != 0:
        sys.exit(run.returncode)
    return command.ROOT / "build/release/ebru"


def render(ebru, shot_file, method, out, arguments, threads):
    words = [ebru, "render", shot_file, "--method", method, "--out", out, "--resume", "--threads", threads]
    for name in ("frames", "size", "spp"):
        if getattr(arguments, name):
            words += [f"--{name}", getattr(arguments, name)]
    for setting in arguments.set:
        words += ["--set", setting]
    out.mkdir(parents=True, exist_ok=True)
    log = out / "render.log"
    with log.open("w") as lines:
        code = subprocess.run(list(map(str, words)), stdout=lines, stderr=subprocess.STDOUT).returncode
    if code != 0:
        print(f"compare.py: error: {method}: `ebru render` ended with {code}:\n{log.read_text().strip()}", file=sys.stderr)
    return code


def render_all(ebru, shot_file, methods, out, arguments):
    """As many at once as there are cores for; the states of a method are sequential, and one render keeps few cores busy."""
    cores = os.cpu_count() or 1
    at_once = max(1, min(len(methods), cores // CORES_PER_RENDER))
    print(f"rendering {', '.join(methods)} ({at_once} at once)", file=sys.stderr, flush=True)
    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        codes = list(pool.map(lambda m: render(ebru, shot_file, m, out / m, arguments, cores // at_once), methods))
    if any(codes):
        sys.exit(max(codes))


def frames_of_run(folder, name, numbers):
    """@return {frame number: path} of what the run has made; what else lies there may be of other settings"""
    paths = {number: folder / f"{name}.{number:04}.exr" for number in sorted(numbers)}
    others = sorted(p.name for p in folder.glob("[!.]*.exr") if p not in paths.values())
    if others:
        print(f"compare.py: note: {folder}: {len(others)} pictures that were not asked for are left out: {others[0]}"
              f"{' to ' + others[-1] if len(others) > 1 else ''}", file=sys.stderr)
    return paths


def strip(paths):
    """@return [(frame number, H x W x 3 uint8)] of the lit picture, evenly in time"""
    numbers = sorted(paths)
    count = min(STRIP_FRAMES, len(numbers))
    chosen = [numbers[round(i * (len(numbers) - 1) / max(1, count - 1))] for i in range(count)]
    return [(n, item_of(frames.read(paths[n], n))["beauty"]) for n in chosen]


def main():
    arguments = parse()
    methods = [name for name in arguments.methods.split(",") if name]
    if not methods or len(set(methods)) < len(methods):
        raise UsageError(f"--methods: got \"{arguments.methods}\", expected different names with commas")
    shot_file = command.find_shot(arguments.shot)
    tables = shot.read(shot_file, arguments.set)
    out = (arguments.out or command.ROOT / "out" / f"{tables['shot']['name']}_comparison").absolute()
    settings = command.settings_of(arguments, tables)
    render_all(arguments.ebru or built_ebru(), shot_file, methods, out, arguments)
    numbers = shot.frames_of(tables, arguments.frames)

    results, pictures, strips = [], {}, {}
    for method in methods:
        paths = frames_of_run(out / method, tables["shot"]["name"], numbers)
        result, pictures[method] = sequence.evaluate(paths, settings, command.Progress(method))
        result["gates"] = []
        command.write_json(out / method / "metrics.json", result)
        report.write_report(out / method / "report.html", result, pictures[method])
        strips[method] = strip(paths)
        results.append(result)
    command.write_json(out / "comparison.json", {result["method"]: result["summary"] for result in results})
    comparison_report.write_comparison(out / "comparison.html", results, pictures, strips)
    print(terminal_table.comparison_table(results))
    print(f"figures  {out / 'comparison.json'}\nreport   {out / 'comparison.html'}")
    return 0


if __name__ == "__main__":
    command.run(main)
