#!/usr/bin/python3
"""Judges a rendered sequence from its EXR frames alone: likeness to the exemplar, optical flow against velocity, coherence.

    scripts/evaluate.py OUT_DIR --shot SHOT
    scripts/evaluate.py OUT_DIR --shot SHOT --require holes=0 flow_excess=0.25 contrast=0.95:1.05
    scripts/evaluate.py BLENDER_DIR --layout blender --exemplar rock.png --texel-size 0.01

Writes metrics.json and report.html to OUT_DIR and a table to the terminal. docs/metrics.md says what the figures mean.
Exit code: 0, 1 when a bound of --require is not kept, 2 usage, 3 input, 4 output.
"""

import argparse
import pathlib
import sys

import requirements

requirements.provide()

from evaluation import command, flow_files, frames, gates, layouts, report, sequence, shot, terminal_table
from evaluation.errors import InputError


def parse():
    lines = __doc__.strip().split("\n\n")
    parser = argparse.ArgumentParser(description=lines[0], epilog="\n\n".join(lines[1:]),
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, metavar="OUT_DIR", help="folder of the frames")
    parser.add_argument("--shot", help="shot file or name of one of scenes/: exemplar, procedural motion")
    parser.add_argument("--pattern", help="which files, when the folder holds several sequences: 'NAME.*.exr'")
    parser.add_argument("--out", type=pathlib.Path, help="folder of metrics.json and report.html (default: OUT_DIR)")
    parser.add_argument("--require", nargs="+", default=[], metavar="METRIC=BOUND",
                        help="METRIC=UPPER, METRIC=LOWER: or METRIC=LOWER:UPPER; METRIC_max or _min for the worst frame")
    parser.add_argument("--layout", choices=layouts.NAMES, default="ebru", help="names and signs of the channels")
    parser.add_argument("--colour", choices=("albedo", "rgb"), default="albedo",
                        help="what is judged (default albedo); rgb: the lit picture, whose highlights do not follow the "
                             "surface")
    parser.add_argument("--exemplar", help="picture the texture should look like (default: the shot's)")
    parser.add_argument("--texel-size", type=float, help="metres of surface per exemplar texel (default: the shot's, else the header's)")
    parser.add_argument("--fps", type=float, help="frames per second (default: the shot's, the header's, else 24)")
    parser.add_argument("--write-flow", choices=flow_files.FORMATS,
                        help="also write forward motion as .flo or KITTI PNG, to OUT/flow/")
    command.add_metric_arguments(parser)
    return parser.parse_args()


def write_flow(kind, paths, folder, settings):
    """@throw InputError if the frames have no motion"""
    folder.mkdir(parents=True, exist_ok=True)
    for number, path in paths.items():
        frame = frames.read(path, number, settings.layout, settings.colour)
        if not frame.has("forward.u", "forward.v", "texture.mask"):
            raise InputError(f"{path}: channels: got no forward.u and forward.v, expected motion vectors to write as --write-flow "
                             f"{kind}; choose another --layout")
        flow_files.write(folder, path.name.rsplit(".", 2)[0], frame, kind)


def main():
    arguments = parse()
    bounds = [gates.parse(text) for text in arguments.require]
    tables = shot.read(command.find_shot(arguments.shot)) if arguments.shot else None
    settings = command.settings_of(arguments, tables)
    paths = frames.find(arguments.folder, arguments.pattern)
    out = arguments.out or arguments.folder
    out.mkdir(parents=True, exist_ok=True)

    if arguments.write_flow:
        write_flow(arguments.write_flow, paths, out / "flow", settings)
    result, pictures = sequence.evaluate(paths, settings, command.Progress("evaluate"))
    result["gates"] = [bound.check(result) for bound in bounds]
    command.write_json(out / "metrics.json", result)
    report.write_report(out / "report.html", result, pictures)

    print(terminal_table.summary_table(result))
    print(f"metrics  {out / 'metrics.json'}\nreport   {out / 'report.html'}")
    failed = [gate for gate in result["gates"] if not gate["passed"]]
    for gate in failed:
        value = f"{gate['value']:.4g}" if gate["value"] is not None else f"nothing ({gate['reason']})"
        print(f"evaluate.py: failed: {gate['metric']}: got {value}, required {gate['bound']}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    command.run(main)
