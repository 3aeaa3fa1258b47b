#!/usr/bin/python3
"""Bakes a named fluid scene with Blender's Mantaflow FLIP solver and converts it to world-space OpenVDB frames.

    scripts/bake_blender.py dam_break --resolution 48 --out scenes/caches/dam_break

Writes OUT/<name>.####.vdb, frames from 1, with two grids (half floats, blosc):
    surface  float level set, metres, voxel = half a solver cell, narrow band of 3 voxels
    vel      staggered vec3s, metres per second, solver cells, only near the fluid
and, for a scene whose solids are no boxes, OUT/<solid>.obj for each.
World space: metres, z up; the frame rate is in the file metadata and in the final report.

The file is two programs: started by python it launches `blender -b --python <this file> -- ...` in a temporary directory
and converts what that leaves behind; started by Blender it builds the scene and bakes it.

Exit codes: 0 done, 2 usage or missing program, 3 the bake or its data are no good, 4 the result cannot be written.
"""
import argparse
import gzip
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

# Blender runs this file without its folder on the path.
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from bake_scenes import SCENES  # noqa: E402

# Mantaflow's clock: a frame is 0.1 * (25 / fps) solver units long, so one second is 2.5 of them.
SOLVER_UNITS_PER_SECOND = 2.5
HALF_WIDTH_VOXELS = 3.0
# `vel` is kept this far outside the surface: trilinear look-ups and one frame of advection beside the fluid still hit data.
VELOCITY_MARGIN_CELLS = 3.0


class BakeError(Exception):
    """A failure with the exit code it stands for."""

    def __init__(self, exitCode, message):
        super().__init__(message)
        self.exitCode = exitCode


def bakeInsideBlender(arguments):
    import bpy

    scene = SCENES[arguments.scene]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = scene.fps
    bpy.context.scene.frame_start = 1
    bpy.context.scene.frame_end = scene.bakedFrames
    domain = scene.build(scene)
    settings = domain.modifiers["Fluid"].domain_settings
    settings.resolution_max = arguments.resolution
    settings.cache_directory = str(arguments.cache)
    settings.cache_type = "ALL"
    settings.cache_data_format = "OPENVDB"
    settings.cache_mesh_format = "BOBJECT"
    settings.openvdb_data_depth = "32"
    settings.cache_frame_start = 1
    settings.cache_frame_end = scene.bakedFrames
    bpy.context.view_layer.objects.active = domain
    bpy.ops.fluid.bake_all()


def readBobj(path):
    """Vertices (domain-centred, longest side 1) and triangles of a Mantaflow mesh."""
    import numpy as np

    data = gzip.decompress(path.read_bytes())
    vertexCount = int(np.frombuffer(data, "<i4", 1, 0)[0])
    points = np.frombuffer(data, "<f4", 3 * vertexCount, 4).reshape(-1, 3)
    offset = 4 + 12 * vertexCount
    normalCount = int(np.frombuffer(data, "<i4", 1, offset)[0])
    offset += 4 + 12 * normalCount
    triangleCount = int(np.frombuffer(data, "<i4", 1, offset)[0])
    triangles = np.frombuffer(data, "<i4", 3 * triangleCount, offset + 4).reshape(-1, 3)
    return points.astype(np.float64), triangles


def dropSpecks(points, triangles, minimumVolume):
    """Removes closed pieces (drops, and bubbles, whose volume is negative) too small to carry a texture."""
    import numpy as np
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    edges = np.concatenate([triangles[:, :2], triangles[:, 1:]])
    graph = coo_matrix((np.ones(len(edges), bool), edges.T), shape=(len(points),) * 2)
    pieceOfVertex = connected_components(graph, directed=False)[1]
    pieceOfTriangle = pieceOfVertex[triangles[:, 0]]
    a, b, c = (points[triangles[:, k]] for k in range(3))
    volumes = np.bincount(pieceOfTriangle, np.einsum("ij,ij->i", a, np.cross(b, c)) / 6)
    return triangles[np.abs(volumes[pieceOfTriangle]) >= minimumVolume]


def worldFromGrid(scene, resolution):
    """Cell size and the world position of the grid's low corner.

    Mantaflow's cells are cubes of longest side / resolution and the mesh is centred in the grid, so with sides that are not
    whole numbers of cells the grid is centred in the domain rather than anchored at its corner.
    """
    import numpy as np

    size = np.array(scene.domain.size())
    cell = size.max() / resolution
    counts = np.maximum(1, np.floor(size / cell + 0.5))
    return cell, np.array(scene.domain.centre()) - counts * cell / 2


def makeSurface(scene, meshPath, cell):
    import numpy as np
    import pyopenvdb as vdb

    voxel = cell / 2
    points, triangles = readBobj(meshPath)
    pointsWorld = np.array(scene.domain.centre()) + max(scene.domain.size()) * points
    triangles = dropSpecks(pointsWorld, triangles, minimumVolume=cell**3)
    transform = vdb.createLinearTransform(voxelSize=voxel)
    surface = vdb.FloatGrid.createLevelSetFromPolygons(
        pointsWorld.astype(np.float32), triangles=triangles.astype(np.uint32), transform=transform, halfWidth=HALF_WIDTH_VOXELS
    )
    surface.name = "surface"
    surface.gridClass = vdb.GridClass.LEVEL_SET
    surface.saveFloatAsHalf = True
    surface.pruneInactive()
    return surface


def denseValues(grid, pad):
    """The grid's active box grown by `pad` voxels as an array, and the index of its low corner."""
    import numpy as np

    low, high = (np.array(corner) for corner in grid.evalActiveVoxelBoundingBox())
    shape = tuple(high - low + 1 + 2 * pad) + ((3,) if grid.valueTypeName == "vec3s" else ())
    values = np.zeros(shape, np.float32)
    grid.copyToArray(values, ijk=tuple(int(v) for v in low - pad))
    return values, low - pad


def distanceToFluid(surface, positionsWorld):
    """Metres from the fluid, 0 inside; exact as far out as the velocity margin needs, unlike the narrow band."""
    import numpy as np
    from scipy.ndimage import distance_transform_edt, map_coordinates

    voxel = surface.transform.voxelSize()[0]
    values, low = denseValues(surface, pad=2 + int(np.ceil(2 * VELOCITY_MARGIN_CELLS)))
    distance = distance_transform_edt(values > 0).astype(np.float32) * voxel
    index = positionsWorld / voxel - low[:, None, None, None]
    return map_coordinates(distance, index, order=1, mode="nearest")


def makeVelocity(scene, dataPath, surface, resolution):
    import numpy as np
    import pyopenvdb as vdb

    # Read by name: the file's `particles` grid uses a codec that no stock reader knows, reading it throws.
    source = vdb.read(str(dataPath), "velocity")
    cell, originWorld = worldFromGrid(scene, resolution)
    values, low = denseValues(source, pad=0)
    values *= cell * SOLVER_UNITS_PER_SECOND
    index = np.moveaxis(np.indices(values.shape[:3]), 0, -1) + low
    centresWorld = np.moveaxis(originWorld + (index + 0.5) * cell, -1, 0)
    keep = distanceToFluid(surface, centresWorld) <= VELOCITY_MARGIN_CELLS * cell
    if not np.isfinite(values[keep]).all():
        raise BakeError(3, f"{dataPath.name}: velocity: got a value that is not finite; bake again at another resolution")
    # Adding 0 turns -0 into 0, which sparse storage can drop.
    values = np.where(keep[..., None], np.round(values / scene.velocityStep) * scene.velocityStep, 0).astype(np.float32) + np.float32(0)

    velocity = vdb.Vec3SGrid()
    velocity.copyFromArray(values, ijk=tuple(int(v) for v in low))
    velocity.pruneInactive()
    transform = vdb.createLinearTransform(voxelSize=cell)
    transform.translate(tuple(float(v) for v in originWorld + 0.5 * cell))
    velocity.transform = transform
    velocity.name = "vel"
    velocity.gridClass = vdb.GridClass.STAGGERED
    velocity.saveFloatAsHalf = True
    return velocity


def convert(scene, name, cache, resolution, staging):
    """Converts the kept frames into `staging`, numbered from 1; returns their paths."""
    import pyopenvdb as vdb

    cell, _ = worldFromGrid(scene, resolution)
    paths = []
    for frame in range(1, scene.keptFrames + 1):
        baked = scene.skippedFrames + frame
        meshPath = cache / "mesh" / f"fluid_mesh_{baked:04d}.bobj.gz"
        dataPath = cache / "data" / f"fluid_data_{baked:04d}.vdb"
        for path in (meshPath, dataPath):
            if not path.is_file():
                raise BakeError(3, f"{name}: frame {baked}: got no {path.name} from Blender, expected one per frame; try another --resolution")
        surface = makeSurface(scene, meshPath, cell)
        if surface.activeVoxelCount() == 0:
            raise BakeError(3, f"{name}: frame {baked}: got an empty fluid surface; raise --resolution")
        velocity = makeVelocity(scene, dataPath, surface, resolution)
        path = staging / f"{name}.{frame:04d}.vdb"
        vdb.write(str(path), grids=[surface, velocity], metadata={"fps": float(scene.fps), "unit": "metre", "frame": frame})
        paths.append(path)
    return paths


def denseLevelSet(path):
    """Signed distance in a box with its low index, from the written file (so the check sees what a reader will see)."""
    import pyopenvdb as vdb

    surface = vdb.read(str(path), "surface")
    return *denseValues(surface, pad=2), surface.transform.voxelSize()[0]


def surfacePoints(values, low, voxel):
    """Zero crossings along the grid's x, y and z edges: points on the surface without meshing it."""
    import numpy as np

    points = []
    for axis in range(3):
        a = np.take(values, range(values.shape[axis] - 1), axis)
        b = np.take(values, range(1, values.shape[axis]), axis)
        where = np.argwhere((a > 0) != (b > 0))
        va, vb = a[tuple(where.T)], b[tuple(where.T)]
        point = where.astype(np.float64)
        point[:, axis] += va / (va - vb)
        points.append((point + low) * voxel)
    return np.concatenate(points)


def sampleStaggered(path, pointsWorld):
    import numpy as np
    import pyopenvdb as vdb
    from scipy.ndimage import map_coordinates

    grid = vdb.read(str(path), "vel")
    values, low = denseValues(grid, pad=1)
    cell = grid.transform.voxelSize()[0]
    index = (pointsWorld - np.array(grid.transform.indexToWorld((0, 0, 0)))) / cell - low
    # Component k is stored on the cell's low face across axis k, half a cell below its centre.
    return np.stack(
        [map_coordinates(values[..., k], (index + 0.5 * (np.arange(3) == k)).T, order=1, mode="nearest") for k in range(3)], -1
    )


def readMotion(scene, fromPath, toPath):
    """What the fit needs of a pair of frames: distanceInVoxels(s, forward) of the moved surface points."""
    import numpy as np
    from scipy.ndimage import map_coordinates

    values, low, voxel = denseLevelSet(fromPath)
    points = surfacePoints(values, low, voxel)
    # What lies on the floor or a wall only slides within itself and would dilute the fit.
    margin = 5 * voxel
    domain = scene.domain
    points = points[np.all((points > np.array(domain.minWorld) + margin) & (points < np.array(domain.maxWorld) - margin), axis=1)]
    startVelocity = sampleStaggered(fromPath, points)
    endVelocity = sampleStaggered(toPath, points + startVelocity / scene.fps)
    nextValues, nextLow, _ = denseLevelSet(toPath)

    def distanceInVoxels(s, forward):
        velocity = startVelocity if forward else 0.5 * (startVelocity + endVelocity)
        moved = (points + velocity * (s / scene.fps)) / voxel - nextLow
        return np.abs(map_coordinates(nextValues, moved.T, order=1, mode="nearest")) / voxel

    return distanceInVoxels


def fitScale(motions, forward):
    """The s that lands the surface points of all `motions` best on the surfaces that follow; median distances at s and at 0."""
    import numpy as np
    from scipy.optimize import minimize_scalar

    def distances(s):
        return np.concatenate([motion(s, forward) for motion in motions])

    s = minimize_scalar(lambda s: distances(s).mean(), bounds=(0.0, 2.0), method="bounded", options={"xatol": 1e-3}).x
    return s, np.median(distances(s)), np.median(distances(0.0))


def report(scene, name, resolution, paths):
    """Prints what was made and checks velocity against surface; throws when they disagree in the sequence's middle half."""
    cell, _ = worldFromGrid(scene, resolution)
    print(f"{name}: {len(paths)} frames at {scene.fps} fps, solver cell {cell:g} m, surface voxel {cell / 2:g} m")
    print(f"domain {scene.domain}")
    for box in scene.obstacles:
        print(f"obstacle {box}, centre {box.centre()}, size {box.size()}")
    print(
        "velocity check: surface points of a frame moved by s * v / fps are to lie on the next surface; residuals are median\n"
        "distances in voxels. 'forward' takes v at the start, 'mean' the mean of both ends, which cancels acceleration and so\n"
        "is a check of units alone. Below 0.5 voxel at s = 0 the surface hardly moves and s means little."
    )
    print("  frames          forward s  residual   mean s  residual   at s = 0")
    motions = [readMotion(scene, first, second) for first, second in zip(paths[:-1], paths[1:])]

    def row(label, some):
        forward, mean = fitScale(some, forward=True), fitScale(some, forward=False)
        print(f"  {label:14}  {forward[0]:9.3f}  {forward[1]:8.2f}  {mean[0]:7.3f}  {mean[1]:8.2f}  {mean[2]:9.2f}")
        return mean

    for first, second, motion in zip(paths[:-1], paths[1:], motions):
        row(f"{first.stem[-4:]} -> {second.stem[-4:]}", [motion])
    quarter = len(motions) // 4
    s, _, atZero = row("middle half", motions[quarter : len(motions) - quarter])
    print(f"size {sum(path.stat().st_size for path in paths) / 1e6:.2f} MB, largest frame {max(path.stat().st_size for path in paths) / 1e6:.2f} MB")
    if atZero < 0.5:
        print("velocity check: undetermined, the surface moves too little in cells of this size")
    elif abs(s - 1) > 0.05:
        raise BakeError(3, f"{name}: velocity check: got s = {s:.3f}, expected 1.00 +- 0.05; nothing was written")


def writeObj(path, mesh):
    """Wavefront OBJ, metres, z up; rounded to tenths of a millimetre, which a solver cell is hundreds of."""
    lines = [f"v {x:.4f} {y:.4f} {z:.4f}" for x, y, z in mesh.points]
    lines += [f"vn {x:.3f} {y:.3f} {z:.3f}" for x, y, z in mesh.normals]
    for face in mesh.faces:
        smooth = max(face) < len(mesh.normals)
        lines.append("f " + " ".join(f"{v + 1}//{v + 1}" if smooth else f"{v + 1}" for v in face))
    path.write_text("\n".join(lines) + "\n")


def publish(paths, out, name):
    """Replaces what is in `out`: every file is copied beside its target and renamed, then older extra frames go."""
    try:
        out.mkdir(parents=True, exist_ok=True)
        for path in paths:
            temporary = out / f"{path.stem}.tmp.{os.getpid()}{path.suffix}"
            try:
                shutil.copyfile(path, temporary)
                os.replace(temporary, out / path.name)
            finally:
                temporary.unlink(missing_ok=True)
        wanted = {path.name for path in paths}
        for old in out.glob(f"{name}.[0-9][0-9][0-9][0-9].vdb"):
            if old.name not in wanted:
                old.unlink()
    except OSError as error:
        raise BakeError(4, f"{out}: cannot write: {error}") from error


def runBlender(arguments, cache):
    blender = shutil.which(arguments.blender)
    if not blender:
        raise BakeError(2, f"{arguments.blender}: no such program; install Blender 3.4 or pass --blender PATH")
    command = [blender, "-b", "--factory-startup", "--threads", str(arguments.threads), "--python-exit-code", "3", "--python", __file__, "--"]
    command += [arguments.scene, "--resolution", str(arguments.resolution), "--cache", str(cache)]
    log = cache.parent / "blender.log"
    with log.open("w") as stream:
        code = subprocess.run(command, stdout=stream, stderr=subprocess.STDOUT, cwd=cache.parent).returncode
    baked = sorted((cache / "mesh").glob("fluid_mesh_*.bobj.gz"))
    if code != 0 or not baked:
        sys.stderr.write("".join(log.read_text(errors="replace").splitlines(keepends=True)[-30:]))
        raise BakeError(3, f"{arguments.scene}: Blender baked {len(baked)} mesh frames and ended with code {code}; its last lines are above")


def parse(argv, insideBlender):
    parser = argparse.ArgumentParser(prog="bake_blender.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="one of: " + ", ".join(SCENES))
    parser.add_argument("--resolution", type=int, default=48, help="solver cells along the domain's longest side (default %(default)s)")
    if insideBlender:
        parser.add_argument("--cache", type=pathlib.Path, required=True)
    else:
        parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for <scene>.####.vdb")
        parser.add_argument("--overwrite", action="store_true", help="replace a sequence that is there already")
        parser.add_argument("--threads", type=int, default=0, help="Blender's threads, 0 = all (default %(default)s)")
        parser.add_argument("--blender", default="blender", help="Blender program (default %(default)s)")
        parser.add_argument("--keep-cache", type=pathlib.Path, help="also copy Blender's own cache to this new folder")
    arguments = parser.parse_args(argv)
    if arguments.scene not in SCENES:
        parser.error(f"scene: got {arguments.scene!r}, expected one of: {', '.join(SCENES)}")
    if not 16 <= arguments.resolution <= 512:
        parser.error(f"--resolution: got {arguments.resolution}, expected 16 to 512")
    return arguments


def main():
    arguments = parse(sys.argv[1:], insideBlender=False)
    scene = SCENES[arguments.scene]
    if not arguments.overwrite and any(arguments.out.glob(f"{arguments.scene}.[0-9][0-9][0-9][0-9].vdb")):
        raise BakeError(2, f"{arguments.out}: has frames of {arguments.scene} already; pass --overwrite to replace them")
    if arguments.keep_cache and arguments.keep_cache.exists():
        raise BakeError(2, f"{arguments.keep_cache}: exists already; --keep-cache wants a new folder")
    with tempfile.TemporaryDirectory(prefix="bake_blender.") as scratch:
        scratch = pathlib.Path(scratch)
        cache = scratch / "cache"
        cache.mkdir()
        runBlender(arguments, cache)
        if arguments.keep_cache:
            shutil.copytree(cache, arguments.keep_cache)
        staging = scratch / "vdb"
        staging.mkdir()
        paths = convert(scene, arguments.scene, cache, arguments.resolution, staging)
        report(scene, arguments.scene, arguments.resolution, paths)
        for name, make in scene.meshes.items():
            paths.append(staging / f"{name}.obj")
            writeObj(paths[-1], make())
        publish(paths, arguments.out, arguments.scene)


if __name__ == "__main__":
    try:
        import bpy  # noqa: F401  present only when Blender runs this file
    except ImportError:
        bpy = None
    try:
        if bpy is not None and "--" in sys.argv:
            bakeInsideBlender(parse(sys.argv[sys.argv.index("--") + 1 :], insideBlender=True))
        else:
            main()
    except BakeError as error:
        print(f"bake_blender.py: {error}", file=sys.stderr)
        sys.exit(error.exitCode)
