"""Sequences whose figures are known: a textured plane under a camera that looks straight down.

The plane is z = 0 with N = (0, 0, 1) and fills the picture or a part of it; the camera is orthographic, so a pixel is
Scene.texels_per_pixel texels wide everywhere. A point of the material is named by its place q0 at frame 0, in pixels
from the picture's middle, x right and y up; at frame f it is at

    q(f) = turned by f * Scene.turn (q0) + f * Scene.shift

so P, velocity, forward and backward are exact. The texture is read from the exemplar at q0, hence rides on the
material, except where a Scene.texture says otherwise.
"""

import dataclasses
import math
import pathlib

import numpy as np
import OpenImageIO as oiio
from scipy import ndimage

ROOT = pathlib.Path(__file__).resolve().parents[2]
CAMERA_HEIGHT = 5.0  # metres over the plane

TEXTURES = (
    "exact",
    "mirrored",  # left and right swapped
    "pieces",  # turned and moved pieces of the exemplar, PIECE_PX wide, with hard seams
    "blurred",  # sigma 1.5 px
    "layers",  # the mean of three that are moved against each other
    "stretched",  # 1.6 : 1
    "shuffled",  # another part of the exemplar in every frame
    "frozen",  # fixed to the screen, whatever moves
    "swimming",  # moves by SWIM px per frame over the material
)
STRETCH = 1.6
BLUR_PX = 1.5
SWIM = 0.5
SHUFFLE_TEXELS = 14
PIECE_PX = 35
LAYERS_TEXELS = ((-14, -26), (12, 2), (-4, 28))


@dataclasses.dataclass(frozen=True)
class Scene:
    exemplar: np.ndarray  # H x W x 3, sRGB-encoded, 0 to 1
    width: int = 128
    height: int = 104
    texels_per_pixel: float = 0.9
    texel_size: float = 0.01  # metres
    fps: tuple = (24, 1)
    first: int = 1
    frames: int = 2
    shift: tuple = (0.0, 0.0)  # px per frame, right and up
    turn: float = 0.0  # rad per frame about the middle, counter-clockwise
    texture: str = "exact"
    extent: str = "all"  # "all", "left" half, "disc", or "border": all but BORDER px
    seed: int = 1

    @property
    def pixel_size(self):
        return self.texels_per_pixel * self.texel_size

    @property
    def disc_radius(self):
        return 0.47 * min(self.width, self.height)

    def with_(self, **changes):
        return dataclasses.replace(self, **changes)


BORDER = 12


def decoded(encoded):
    """From the sRGB curve to scene-linear."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((np.maximum(encoded, 0.04045) + 0.055) / 1.055) ** 2.4)


def crop_exemplar(folder, name="pebbles", side=128):
    """Writes a corner of one of scenes/exemplars: the search for windows takes time with their number.
    @return the PNG's path and its pixels, H x W x 3, sRGB-encoded"""
    picture = oiio.ImageBuf(str(ROOT / f"scenes/exemplars/{name}.png"))
    pixels = picture.get_pixels(oiio.FLOAT)[:side, :side, :3]
    path = folder / f"{name}_{side}.png"
    write_png(path, pixels)
    return path, pixels


def write_png(path, pixels):
    """@param pixels  H x W x C, sRGB-encoded, 0 to 1; written with 8 bits"""
    height, width, channels = pixels.shape
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), oiio.ImageSpec(width, height, channels, oiio.UINT8)), output.geterror()
    assert output.write_image(np.ascontiguousarray(pixels, np.float32)), output.geterror()
    output.close()


def _turned(points, angle):
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def places(scene):
    """@return H x W x 2: pixels from the picture's middle, x right and y up"""
    rows, columns = np.mgrid[0 : scene.height, 0 : scene.width]
    return np.stack([columns + 0.5 - scene.width / 2, scene.height / 2 - rows - 0.5], axis=-1)


def material(scene, q, frame):
    """@return where the points that are at q in `frame` were at frame 0"""
    return _turned(q - frame * np.array(scene.shift), -frame * scene.turn)


def carried(scene, q, frame, to):
    return _turned(material(scene, q, frame), to * scene.turn) + to * np.array(scene.shift)


def fluid(scene):
    """@return H x W bool, fixed to the screen"""
    q = places(scene)
    if scene.extent == "left":
        return q[..., 0] < 0
    if scene.extent == "disc":
        return np.linalg.norm(q, axis=-1) < scene.disc_radius
    inside = np.ones((scene.height, scene.width), bool)
    if scene.extent == "border":
        inside[:] = False
        inside[BORDER:-BORDER, BORDER:-BORDER] = True
    return inside


def _random(scene, *stream):
    return np.random.default_rng([scene.seed, *stream])


def _pieces(scene, q, middle):
    """@return exemplar coordinates, texels: every point follows the nearest corner of a jittered grid"""
    rng = _random(scene, 0)
    reach = 3 * max(scene.width, scene.height) // 4
    grid = np.arange(-reach, reach, PIECE_PX)
    corners = np.stack(np.meshgrid(grid, grid), axis=-1).reshape(-1, 2)
    corners = corners + PIECE_PX * rng.uniform(-0.3, 0.3, corners.shape)
    nearest = np.linalg.norm(q[:, :, None] - corners, axis=-1).argmin(axis=-1)
    # A point is at most one grid step from its corner.
    within = middle - 1.05 * PIECE_PX * scene.texels_per_pixel
    sources = middle + rng.uniform(-within, within, corners.shape)
    angles = rng.uniform(0, 2 * math.pi, len(corners))
    away = (q - corners[nearest]) * scene.texels_per_pixel * [1, -1]
    c, s = np.cos(angles)[nearest], np.sin(angles)[nearest]
    x, y = away[..., 0], away[..., 1]
    return sources[nearest] + np.stack([c * x - s * y, s * x + c * y], axis=-1)


def coordinates(scene, frame):
    """@return H x W x 2: texels of the exemplar, x right and y down; the middle of the first texel is at 0.5"""
    q = places(scene)
    q0 = q if scene.texture == "frozen" else material(scene, q, frame)
    middle = np.array(scene.exemplar.shape[1::-1]) / 2
    if scene.texture == "pieces":
        return _pieces(scene, q0, middle)
    if scene.texture == "swimming":
        q0 = q0 - [SWIM * frame, 0]
    if scene.texture == "shuffled":
        q0 = q0 + _random(scene, 1, frame).uniform(-SHUFFLE_TEXELS, SHUFFLE_TEXELS, 2)
    if scene.texture == "mirrored":
        q0 = q0 * [-1, 1]
    if scene.texture == "stretched":
        q0 = q0 / [STRETCH, 1]
    return middle + scene.texels_per_pixel * q0 * [1, -1]


def _read(pixels, at):
    """Cubic, mirrored beyond the border. @param at  H x W x 2, as coordinates() gives them"""
    index = [at[..., 1] - 0.5, at[..., 0] - 0.5]
    channels = [ndimage.map_coordinates(pixels[..., c], index, order=3, mode="reflect") for c in range(3)]
    return np.stack(channels, axis=-1)


def colours(scene, frame):
    """@return H x W x 3, sRGB-encoded"""
    at = coordinates(scene, frame)
    if scene.texture == "layers":
        return np.mean([_read(scene.exemplar, at + offset) for offset in LAYERS_TEXELS], axis=0)
    pixels = scene.exemplar
    if scene.texture == "blurred":
        sigma = BLUR_PX * scene.texels_per_pixel
        pixels = ndimage.gaussian_filter(pixels, (sigma, sigma, 0), mode="reflect")
    return np.clip(_read(pixels, at), 0, 1)


def planes(scene, frame):
    """@return ebru's channel name -> H x W, docs/aovs.md"""
    q, mask = places(scene), fluid(scene)
    zero = np.zeros(mask.shape)
    found = {}

    def layer(name, parts, values):
        for i, part in enumerate(parts):
            found[f"{name}.{part}" if name else part] = np.where(mask, values[..., i], 0).astype(np.float32)

    albedo = decoded(colours(scene, frame))
    layer("", "RGBA", np.dstack([0.8 * albedo, zero + 1]))
    layer("albedo", "RGB", albedo)
    layer("", "Z", (zero + CAMERA_HEIGHT)[..., None])
    layer("P", "XYZ", np.dstack([scene.pixel_size * q, zero]))
    layer("N", "XYZ", np.dstack([zero, zero, zero + 1]))
    from_middle = q - frame * np.array(scene.shift)
    per_frame = np.array(scene.shift) + scene.turn * np.stack([-from_middle[..., 1], from_middle[..., 0]], axis=-1)
    rate = scene.fps[0] / scene.fps[1]
    layer("velocity", "XYZ", np.dstack([scene.pixel_size * rate * per_frame, zero]))
    layer("forward", "uv", carried(scene, q, frame, frame + 1) - q)
    layer("backward", "uv", carried(scene, q, frame, frame - 1) - q)
    layer("texture", "st", coordinates(scene, frame) / scene.exemplar.shape[1::-1])
    layer("texture", ("age", "distortion", "id", "mask"), np.dstack([zero + frame, zero + 1, zero + 7, zero + 1]))
    return found


def world_to_ndc(scene):
    """Row vectors, (0, 0) upper left; z is metres from the camera."""
    across, down = scene.width * scene.pixel_size, scene.height * scene.pixel_size
    return ((1 / across, 0, 0, 0), (0, -1 / down, 0, 0), (0, 0, -1, 0), (0.5, 0.5, CAMERA_HEIGHT, 1))


def world_to_camera(scene):
    return ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, -1, 0), (0, 0, CAMERA_HEIGHT, 1))


def _blender(found):
    """Cycles' passes: Vector.XY = previous - current, Vector.ZW = current - next."""
    names = {**{c: f"Combined.{c}" for c in "RGBA"}, **{f"albedo.{c}": f"DiffCol.{c}" for c in "RGB"}, "Z": "Depth.Z",
             **{f"P.{c}": f"Position.{c}" for c in "XYZ"}, **{f"N.{c}": f"Normal.{c}" for c in "XYZ"},
             "texture.s": "UV.U", "backward.u": "Vector.X", "backward.v": "Vector.Y"}
    written = {f"ViewLayer.{name}": found[ours] for ours, name in names.items() if ours in found}
    for ours, name in (("forward.u", "Vector.Z"), ("forward.v", "Vector.W")):
        if ours in found:
            written[f"ViewLayer.{name}"] = -found[ours]
    if "texture.t" in found:
        written["ViewLayer.UV.V"] = 1 - found["texture.t"]  # up the image
    if "texture.mask" in found:
        written["ViewLayer.IndexOB.X"] = 3 * found["texture.mask"]  # the number of an object
    return written


def _nuke(found):
    """A Write node's names: colours as words, depth in a layer of its own, vectors as colours or in lower case."""
    words = {"R": "red", "G": "green", "B": "blue", "A": "alpha"}
    written = {}
    for name, values in found.items():
        layer, _, last = name.rpartition(".")
        if layer in ("P", "N"):
            written[f"{layer}.{dict(X='red', Y='green', Z='blue')[last]}"] = values
        elif layer == "velocity":
            written[f"{layer}.{last.lower()}"] = values
        elif layer == "albedo":
            written[f"{layer}.{words[last]}"] = values
        else:
            written["depth.Z" if name == "Z" else name] = values
    return written


LAYOUTS = {"ebru": lambda found: found, "blender": _blender, "nuke": _nuke}


def write_frame(path, scene, frame, layout="ebru", omit=(), change=None, header=True):
    """@param omit  layers or channels that are left out
    @param change  called with (planes, frame) before they are written
    @param header  whether camera, rate and texel size are in it"""
    found = planes(scene, frame)
    if change:
        change(found, frame)
    found = {name: values for name, values in found.items()
             if name not in omit and name.rpartition(".")[0] not in omit}
    written = LAYOUTS[layout](found)
    colour = {name for ours, values in found.items() if ours.rpartition(".")[0] in ("", "albedo") and ours != "Z"
              for name in written if written[name] is values}
    spec = oiio.ImageSpec(scene.width, scene.height, len(written), oiio.FLOAT)
    spec.channelnames = tuple(written)
    spec.channelformats = tuple(oiio.TypeDesc(oiio.HALF if name in colour else oiio.FLOAT) for name in written)
    spec.attribute("compression", "zip")
    if header:
        spec.attribute("worldToNDC", "matrix", tuple(np.ravel(world_to_ndc(scene)).tolist()))
        spec.attribute("worldToCamera", "matrix", tuple(np.ravel(world_to_camera(scene)).astype(float).tolist()))
        spec.attribute("FramesPerSecond", "rational", tuple(scene.fps))
        spec.attribute("imageCounter", "int", frame)
        spec.attribute("ebru:texelSizeWorld", "float", scene.texel_size)
        spec.attribute("ebru:shot", "plane")
        spec.attribute("ebru:method", scene.texture)
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec), output.geterror()
    assert output.write_image(np.dstack(list(written.values())).astype(np.float32)), output.geterror()
    output.close()


def write(folder, scene, name="plane", numbers=None, **options):
    """@param numbers  frames to write (default: all of the scene)  @param options  of write_frame
    @return {number: path}"""
    folder.mkdir(parents=True, exist_ok=True)
    paths = {}
    for frame in numbers or range(scene.first, scene.first + scene.frames):
        paths[frame] = folder / f"{name}.{frame:04}.exr"
        write_frame(paths[frame], scene, frame, **options)
    return paths
