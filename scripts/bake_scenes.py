"""The scenes that bake_blender.py bakes: domain, solids and fluid of each, and how they are set up inside Blender.

Metres, z up. Nothing here needs Blender until a scene's `build` is called.
"""
import dataclasses
import math

import numpy as np

EARTH_GRAVITY = 9.81  # m/s2


@dataclasses.dataclass(frozen=True)
class Box:
    minWorld: tuple
    maxWorld: tuple

    def centre(self):
        return tuple((a + b) / 2 for a, b in zip(self.minWorld, self.maxWorld))

    def size(self):
        return tuple(b - a for a, b in zip(self.minWorld, self.maxWorld))


@dataclasses.dataclass(frozen=True)
class Mesh:
    """A closed solid: faces turn counter-clockwise seen from outside, `normals` are those of the first vertices only."""

    points: np.ndarray  # N x 3
    normals: np.ndarray  # M x 3, unit; vertices from M on are on flat sides that need none
    faces: list  # of tuples of vertex numbers, from 0


@dataclasses.dataclass(frozen=True)
class Scene:
    """What the converter must know about a scene; everything else is the builder's business."""

    build: object  # function(scene): called inside Blender, returns the domain object
    domain: Box  # sides that are whole numbers of cells keep obstacle and fluid exactly aligned
    obstacles: tuple  # of Box
    bakedFrames: int
    keptFrames: int
    fps: int
    skippedFrames: int = 0  # Blender's first frames, which are left out: what is kept begins in motion
    meshes: dict = dataclasses.field(default_factory=dict)  # name: function that returns a Mesh; solids that are no boxes
    # m/s that velocities are rounded to: far under what the solver resolves, and it takes a third off `vel`.
    velocityStep: float = 1 / 256


def addBox(name, box, bevelWorld=0.0):
    import bpy

    bpy.ops.mesh.primitive_cube_add(size=1, location=box.centre())
    thing = bpy.context.object
    thing.name = name
    thing.scale = box.size()
    # Mantaflow reads sizes from the mesh, and a bevel on a scaled object would be as skewed as its scale.
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    if bevelWorld > 0:
        bevel = thing.modifiers.new("Bevel", "BEVEL")
        bevel.width = bevelWorld
        bevel.segments = 6
        bpy.ops.object.modifier_apply(modifier="Bevel")
    return thing


def addBall(name, centre, radius):
    import bpy

    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=radius, location=centre)
    thing = bpy.context.object
    thing.name = name
    return thing


def addMesh(name, mesh):
    import bpy

    data = bpy.data.meshes.new(name)
    data.from_pydata([tuple(float(v) for v in point) for point in mesh.points], [], mesh.faces)
    thing = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(thing)
    return thing


def addFluidModifier(thing, kind):
    modifier = thing.modifiers.new("Fluid", "FLUID")
    modifier.fluid_type = kind
    return modifier


def addLiquid(thing, behaviour):
    settings = addFluidModifier(thing, "FLOW").flow_settings
    settings.flow_type = "LIQUID"
    settings.flow_behavior = behaviour
    return settings


def addObstacles(scene):
    things = [addBox(f"obstacle{index}", box) for index, box in enumerate(scene.obstacles)]
    things += [addMesh(name, make()) for name, make in scene.meshes.items()]
    for thing in things:
        addFluidModifier(thing, "EFFECTOR").effector_settings.effector_type = "COLLISION"


def addDomain(scene, gravity=EARTH_GRAVITY):
    import bpy

    bpy.context.scene.gravity = (0, 0, -gravity)
    settings = addFluidModifier(addBox("domain", scene.domain), "DOMAIN").domain_settings
    settings.domain_type = "LIQUID"
    settings.use_mesh = True
    settings.mesh_scale = 2
    settings.mesh_particle_radius = 2.0
    settings.mesh_smoothen_pos = 2
    settings.mesh_smoothen_neg = 2
    settings.use_adaptive_timesteps = True
    settings.cfl_condition = 2.0
    settings.timesteps_min = 2
    settings.timesteps_max = 8
    return settings


def buildDamBreak(scene):
    """A column across the whole tank collapses, runs around and over a box and up the far wall."""
    # Half of earth's gravity: the 2 m tank moves like a 4 m one, slow enough for a surface to be followed by eye.
    settings = addDomain(scene, EARTH_GRAVITY / 2)
    # A touch of PIC damps the spray: broad sheets are what a texture needs.
    settings.flip_ratio = 0.9
    # Reaches beyond back and sides, so that the fluid touches those walls from the start and only its front edge is free.
    addLiquid(addBox("column", Box((-1.2, -0.7, -0.2), (-0.42, 0.7, 0.66)), bevelWorld=0.10), "GEOMETRY")
    addObstacles(scene)
    return settings.id_data


def buildViscousDrop(scene):
    """A ball of syrup falls about its diameter onto the floor, spreads and almost stops."""
    settings = addDomain(scene, EARTH_GRAVITY / 2)
    settings.flip_ratio = 0.9
    # The viscosity solver makes errors at the surface that pull tails out of a freely falling ball. It makes fewer in fewer
    # steps and off the cells' symmetries, and none that show while the ball is so viscous that it keeps its shape.
    settings.timesteps_min = 1
    settings.timesteps_max = 4
    settings.use_viscosity = True
    for frame, viscosity in ((10, 1.0), (11, 0.02)):
        settings.viscosity_value = viscosity
        settings.keyframe_insert("viscosity_value", frame=frame)
    addLiquid(addBall("ball", (0.013, -0.009, 0.853), 0.27), "GEOMETRY")
    return settings.id_data


def slopeHeight(x, y):
    """z of the slope that the lava creeps down: a shallow valley, uneven, with a knoll in its way."""
    height = 0.40 - 0.31 * x + 0.12 * np.minimum((y / 0.8) ** 2, 2)
    height = height + 0.15 * np.exp(-((x + 0.05) ** 2 + (y + 0.05) ** 2) / 0.14**2)
    # Waves in directions that never repeat, the longer the higher: uneven ground without a table of random numbers.
    for k, wavelength in enumerate((0.95, 0.71, 0.53, 0.41, 0.32, 0.26)):
        angle = k * math.pi * (3 - math.sqrt(5))
        height = height + 0.035 * wavelength * np.sin(2 * math.pi * (x * math.cos(angle) + y * math.sin(angle)) / wavelength + 2.4 * k)
    return height


def slopeMesh():
    """The slope as a solid. It reaches beyond the domain on all sides, where only a picture sees it, and under the ground."""
    spacing, depth = 0.05, -0.4
    xs, ys = np.arange(-1.6, 1.9001, spacing), np.arange(-1.3, 1.3001, spacing)
    x, y = np.meshgrid(xs, ys, indexing="ij")
    top = np.stack([x, y, slopeHeight(x, y)], -1).reshape(-1, 3)
    step = 1e-4
    gradient = [slopeHeight(x + dx, y + dy) - slopeHeight(x - dx, y - dy) for dx, dy in ((step, 0), (0, step))]
    normals = np.stack([-gradient[0], -gradient[1], np.full_like(x, 2 * step)], -1).reshape(-1, 3)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)

    number = np.arange(len(top)).reshape(x.shape)
    faces = [tuple(q) for q in np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], -1).reshape(-1, 4).tolist()]
    rim = np.concatenate([number[:-1, 0], number[-1, :-1], number[:0:-1, -1], number[0, :0:-1]])
    low = top[rim] * (1, 1, 0) + (0, 0, depth)
    # The rim's vertices are there twice: once with the slope's normals, and once for the sides, which are flat.
    upper = len(top) + np.arange(len(rim))
    lower = upper + len(rim)
    faces += [tuple(q) for q in np.stack([np.roll(upper, -1), upper, lower, np.roll(lower, -1)], -1).tolist()]
    faces.append(tuple(lower[::-1].tolist()))
    return Mesh(np.concatenate([top, top[rim], low]), normals, faces)


def buildLava(scene):
    """Lava wells up at the head of a slope and creeps down it, around a knoll."""
    settings = addDomain(scene)
    settings.flip_ratio = 0.9
    settings.use_viscosity = True
    settings.viscosity_value = 0.004
    source = (-0.92, 0.0, float(slopeHeight(-0.92, 0.0)) + 0.14)
    flow = addLiquid(addBall("source", source, 0.24), "INFLOW")
    flow.use_initial_velocity = True
    flow.velocity_coord = (1.1, 0.0, -0.3)
    addObstacles(scene)
    return settings.id_data


SCENES = {
    "dam_break": Scene(
        build=buildDamBreak,
        domain=Box((-1.0, -0.5, 0.0), (1.0, 0.5, 1.0)),
        obstacles=(Box((0.0, -0.2, 0.0), (0.25, 0.2, 0.16)),),
        bakedFrames=32,
        keptFrames=28,
        fps=24,
    ),
    "viscous_drop": Scene(
        build=buildViscousDrop,
        domain=Box((-0.8, -0.8, 0.0), (0.8, 0.8, 1.2)),
        obstacles=(),
        bakedFrames=32,
        keptFrames=28,
        fps=24,
        skippedFrames=4,
    ),
    "lava": Scene(
        build=buildLava,
        domain=Box((-1.2, -0.8, 0.0), (1.2, 0.8, 1.2)),
        obstacles=(),
        bakedFrames=34,
        keptFrames=30,
        fps=24,
        skippedFrames=4,
        meshes={"slope": slopeMesh},
        velocityStep=1 / 128,
    ),
}
