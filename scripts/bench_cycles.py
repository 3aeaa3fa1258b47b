#!/usr/bin/python3
"""Path tracing against Blender's Cycles: one mesh, camera, resolution and light, the same samples, bounces and threads.

    scripts/bench_cycles.py
    scripts/bench_cycles.py --size 480x270 --spp 64 --runs 5

Both render a frame of the default shot's cache, diffuse without texture, on a grey ground under a sun and a sky of one colour,
without denoiser and adaptive sampling. Times are of hierarchy and light transport, without starting, reading and writing;
the runs of the two take turns. The error is the root mean square difference to a picture of the same program with many
samples. Exit codes: 0 done, 2 usage or no Blender (nothing is measured then), 3 a program failed.
"""

import argparse
import json
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
MARK = "BENCH_CYCLES "

CAMERA = {"position": (1.75, -2.75, 1.75), "target": (0.0, 0.0, 0.2), "vertical_fov_deg": 25.0}
SUN = {"direction": (-0.3, -0.55, 0.85), "intensity": 0.9, "angular_diameter_deg": 2.0}
SKY = 0.35
ALBEDO, GROUND_ALBEDO, GROUND_HEIGHT = 0.6, 0.3, 0.033


# Run by python.


def parse():
    lines = __doc__.strip().split("\n\n")
    parser = argparse.ArgumentParser(description=lines[0], epilog="\n\n".join(lines[1:]),
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ebru", default=str(ROOT / "build/release/ebru"), help="the program (default: the release build)")
    parser.add_argument("--blender", default="blender", help="the program")
    parser.add_argument("--frame", type=int, default=14, help="of the default shot")
    parser.add_argument("--size", default="640x360", help="WxH")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--reference-spp", type=int, default=4096)
    parser.add_argument("--bounces", type=int, default=4)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--runs", type=int, default=3)
    return parser.parse_args()


def run(command, what):
    result = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if result.returncode != 0:
        sys.stderr.write(result.stdout[-2000:] + result.stderr[-2000:])
        print(f"bench_cycles: {what}: ended with {result.returncode}", file=sys.stderr)
        sys.exit(3)
    return result.stdout


def shot_text(mesh, arguments):
    width, height = arguments.size.split("x")
    vector = lambda v: "[" + ", ".join(str(c) for c in v) + "]"
    return f"""
[shot]
name = "bench"
first_frame = 1
last_frame = 1
[fluid]
source = "mesh"
path = "{mesh}"
[texture]
method = "plain"
[camera]
position = {vector(CAMERA["position"])}
target = {vector(CAMERA["target"])}
vertical_fov_deg = {CAMERA["vertical_fov_deg"]}
size = [{width}, {height}]
[render]
max_bounces = {arguments.bounces}
[material]
type = "diffuse"
roughness = 0.0
colour = [{ALBEDO}, {ALBEDO}, {ALBEDO}]
[ground]
enabled = true
height = {GROUND_HEIGHT}
radius = 20.0
colour = [{GROUND_ALBEDO}, {GROUND_ALBEDO}, {GROUND_ALBEDO}]
[[light]]
type = "sun"
direction = {vector(SUN["direction"])}
intensity = {SUN["intensity"]}
angular_diameter_deg = {SUN["angular_diameter_deg"]}
[[light]]
type = "environment"
intensity = {SKY}
"""


class Ebru:
    name = "ebru"

    def __init__(self, arguments, folder, mesh):
        self.arguments, self.folder = arguments, folder
        self.shot = folder / "bench.toml"
        self.shot.write_text(shot_text(mesh, arguments))

    def render(self, spp, seed, target):
        """@return seconds"""
        out = self.folder / "ebru"
        text = run([self.arguments.ebru, "render", self.shot, "--spp", spp, "--seed", seed, "--out", out, "--overwrite",
                    "--threads", self.arguments.threads], "ebru")
        shutil.move(out / "bench.0001.exr", target)
        phases = dict(re.findall(r"^(render: \w+) +\d+ +([\d.]+)", text, re.MULTILINE))
        return float(phases["render: hierarchy"]) + float(phases["render: light"])


class Cycles:
    name = "Cycles"

    def __init__(self, arguments, folder, mesh):
        self.arguments, self.folder, self.mesh = arguments, folder, mesh

    def render(self, spp, seed, target):
        """@return seconds"""
        job = {"mesh": str(self.mesh), "spp": spp, "seed": seed, "target": str(target), "size": self.arguments.size,
               "bounces": self.arguments.bounces, "threads": self.arguments.threads}
        file = self.folder / "job.json"
        file.write_text(json.dumps(job))
        text = run([self.arguments.blender, "-b", "--factory-startup", "-noaudio", "--python-exit-code", "1", "--python",
                    __file__, "--", file], "Blender")
        return float(re.search(MARK + r"([\d.]+)", text).group(1))


def root_mean_square(a, b):
    import numpy
    import OpenImageIO as oiio

    colours = []
    for path in (a, b):
        image = oiio.ImageBuf(str(path))
        names = [n.split(".")[-1] for n in image.spec().channelnames]
        pixels = image.get_pixels(oiio.FLOAT)
        colours.append(numpy.stack([pixels[..., names.index(c)] for c in "RGB"], axis=-1))
    return float(numpy.sqrt(numpy.mean((colours[0] - colours[1]) ** 2))), [float(c.mean()) for c in colours]


def measure(arguments, folder):
    export = folder / "export"
    run([arguments.ebru, "export", ROOT / "scenes/dam_break.toml", "--frames", arguments.frame, "--method", "particles", "--set",
         "texture.texel_size=0.05", "--out", export], "ebru export")
    mesh = next((export / "geometry").glob("*.ply"))
    programs = [kind(arguments, folder, mesh) for kind in (Ebru, Cycles)]
    seconds, pictures = {p.name: [] for p in programs}, {}
    for number in range(arguments.runs):
        for program in programs:
            pictures[program.name] = folder / f"{program.name}.exr"
            seconds[program.name].append(program.render(arguments.spp, 7 + number, pictures[program.name]))
    print(f"{arguments.size}, {arguments.spp} samples, {arguments.bounces} bounces, {arguments.threads} threads")
    medians, errors = {}, {}
    for program in programs:
        reference = folder / f"{program.name}.reference.exr"
        program.render(arguments.reference_spp, 1, reference)
        errors[program.name], means = root_mean_square(pictures[program.name], reference)
        medians[program.name] = statistics.median(seconds[program.name])
        print(f"{program.name:7} {medians[program.name]:7.2f} s (median of {arguments.runs})   error {errors[program.name]:.5f}"
              f"   mean {means[1]:.4f}")
    print(f"ebru / Cycles: time {medians['ebru'] / medians['Cycles']:.2f}, error {errors['ebru'] / errors['Cycles']:.2f}")


def main():
    arguments = parse()
    if shutil.which(arguments.blender) is None:
        print(f"bench_cycles: {arguments.blender}: not found; install Debian's package blender", file=sys.stderr)
        sys.exit(2)
    with tempfile.TemporaryDirectory(prefix="bench_cycles_") as folder:
        measure(arguments, pathlib.Path(folder))


# Run by Blender.


def build_scene(job):
    import bpy
    from mathutils import Vector

    def diffuse(name, albedo):
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        nodes = material.node_tree.nodes
        nodes.clear()
        shader, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
        shader.inputs["Color"].default_value = (albedo, albedo, albedo, 1.0)
        shader.inputs["Roughness"].default_value = 0.0
        material.node_tree.links.new(shader.outputs[0], output.inputs["Surface"])
        return material

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    bpy.ops.import_mesh.ply(filepath=job["mesh"])
    fluid = bpy.context.object
    fluid.data.materials.clear()
    fluid.data.materials.append(diffuse("fluid", ALBEDO))
    fluid.data.polygons.foreach_set("use_smooth", [True] * len(fluid.data.polygons))
    bpy.ops.mesh.primitive_circle_add(vertices=256, radius=20.0, fill_type="NGON", location=(0.0, 0.0, GROUND_HEIGHT))
    bpy.context.object.data.materials.append(diffuse("ground", GROUND_ALBEDO))

    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    position, target = Vector(CAMERA["position"]), Vector(CAMERA["target"])
    camera.location = position
    camera.rotation_euler = (target - position).to_track_quat("-Z", "Y").to_euler()
    import math

    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle = math.radians(CAMERA["vertical_fov_deg"])
    scene.camera = camera

    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    scene.collection.objects.link(sun)
    # A sun of intensity 1 lights a white surface that faces it to 1: irradiance pi.
    sun.data.energy = math.pi * SUN["intensity"]
    sun.data.angle = math.radians(SUN["angular_diameter_deg"])
    sun.rotation_euler = Vector(SUN["direction"]).to_track_quat("Z", "Y").to_euler()
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (SKY, SKY, SKY, 1.0)
    return scene


def set_up(scene, job):
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = job["spp"]
    cycles.seed = job["seed"]
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = job["bounces"] - 1
    cycles.sample_clamp_indirect = cycles.sample_clamp_direct = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type = "BLACKMAN_HARRIS"
    cycles.filter_width = 2.0
    scene.render.threads_mode = "FIXED"
    scene.render.threads = job["threads"]
    scene.render.film_transparent = True
    width, height = job["size"].split("x")
    scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
    scene.render.resolution_percentage = 100
    scene.render.filepath = job["target"]
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"


def inside_blender():
    import time

    import bpy

    job = json.loads(pathlib.Path(sys.argv[sys.argv.index("--") + 1]).read_text())
    scene = build_scene(job)
    set_up(scene, job)
    begin = time.monotonic()
    bpy.ops.render.render()
    seconds = time.monotonic() - begin
    bpy.data.images["Render Result"].save_render(job["target"])
    print(f"{MARK}{seconds:.3f}")


try:
    import bpy  # noqa: F401
except ImportError:
    main()
else:
    inside_blender()
