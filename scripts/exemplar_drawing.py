"""What make_exemplars.py draws with: colour, noise, packings, cushions and light, on a grid finer than the picture.

Everything is in linear light. Positions, lengths and heights are in pixels of the finished picture, x right, y down; fields are
arrays of the fine grid, FINE samples per pixel along each axis. Light comes from the top left.
"""
import numpy as np
from scipy.ndimage import distance_transform_edt, gaussian_filter
from scipy.spatial import cKDTree

FINE = 3
LIGHT = np.array([-0.55, -0.60, 0.58]) / np.linalg.norm([-0.55, -0.60, 0.58])


def fromSrgb(value):
    value = np.asarray(value, float)
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def toSrgb(value):
    value = np.clip(value, 0, 1)
    return np.where(value <= 0.0031308, value * 12.92, 1.055 * value ** (1 / 2.4) - 0.055)


def colour(code):
    """Linear RGB of a "#rrggbb"."""
    return fromSrgb([int(code[i : i + 2], 16) / 255 for i in (1, 3, 5)])


def palette(*codes):
    return np.array([colour(code) for code in codes])


def mix(a, b, weight):
    """a where weight is 0, b where it is 1; weight has one value per pixel."""
    return a + (b - a) * weight[..., None]


def smoothstep(low, high, x):
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def ramp(stops, value):
    """Colour at `value` in 0..1 along evenly spaced colours."""
    at = np.linspace(0, 1, len(stops))
    return np.stack([np.interp(value, at, stops[:, c]) for c in range(3)], -1)


def shoulder(picture):
    """Rolls highlights off towards 1 instead of clipping them."""
    return np.where(picture < 0.7, picture, 0.7 + 0.3 * (1 - np.exp(-(np.maximum(picture, 0.7) - 0.7) / 0.3)))


def grid(size):
    """Sample positions x, y of the fine grid."""
    at = (np.arange(size * FINE) + 0.5) / FINE
    return np.meshgrid(at, at)


def noise(rng, size, wavelength):
    """Smooth noise with features about `wavelength` across, mean 0, deviation 1."""
    field = gaussian_filter(rng.standard_normal((size * FINE,) * 2), wavelength * FINE / 5, mode="wrap")
    return (field - field.mean()) / field.std()


def fractal(rng, size, wavelength, octaves=4):
    field = sum(noise(rng, size, wavelength / 2**k) * 0.55**k for k in range(octaves))
    return field / field.std()


def warped(rng, size, wavelength, amount):
    """The grid pushed about by noise, which turns straight edges into natural ones."""
    x, y = grid(size)
    return x + amount * noise(rng, size, wavelength), y + amount * noise(rng, size, wavelength)


def scatter(rng, size, spacing, relaxations):
    """Points about `spacing` apart, beyond the picture's edge too; more relaxations make them more even (Lloyd's method)."""
    low, high = -2 * spacing, size + 2 * spacing
    points = rng.uniform(low, high, (int(((high - low) / spacing) ** 2), 2))
    at = np.arange(low, high, spacing / 12)
    samples = np.stack(np.meshgrid(at, at), -1).reshape(-1, 2)
    for _ in range(relaxations):
        owner = cKDTree(points).query(samples)[1]
        count = np.maximum(np.bincount(owner, minlength=len(points)), 1)
        points = np.stack([np.bincount(owner, samples[:, k], len(points)) / count for k in (0, 1)], -1)
    return points


def cells(points, x, y, neighbours=8):
    """Voronoi diagram: owner of every sample, and its distance to the nearest cell edge."""
    samples = np.stack([x, y], -1)
    owner = cKDTree(points).query(samples, neighbours)[1]
    mine = points[owner[..., 0]]
    edge = np.full(x.shape, np.inf)
    for k in range(1, neighbours):
        other = points[owner[..., k]]
        across = other - mine
        edge = np.minimum(edge, (((mine + other) / 2 - samples) * across).sum(-1) / np.linalg.norm(across, axis=-1))
    return owner[..., 0], edge


def packDiscs(rng, size, radii, overlap):
    """Discs of the given radii (largest first), each dropped where it overlaps its elders by at most `overlap` of its radius."""
    centres, sizes = np.empty((0, 2)), np.empty(0)
    for radius in sorted(radii, reverse=True):
        for _ in range(60):
            centre = rng.uniform(-12, size + 12, 2)
            if len(sizes) == 0 or (np.linalg.norm(centres - centre, axis=1) > sizes + radius * (1 - overlap)).all():
                centres, sizes = np.vstack([centres, centre]), np.append(sizes, radius)
                break
    return centres, sizes


def inside(mask):
    """Distance in pixels from the outside of a mask of the fine grid."""
    return distance_transform_edt(mask) / FINE


def rounded(mask, radius):
    """The mask with its corners rounded: all that a disc of `radius` rolled inside it can reach."""
    return inside(inside(mask) <= radius) * -1 + radius > 0


def inflate(mask, steps=120):
    """A cushion over every piece of the mask: sqrt(2u) where u solves laplace(u) = -2 with u = 0 outside.

    On a disc this is a dome as high as its radius over sqrt(2); unlike a distance transform it has no creases.
    Conjugate gradients; the pieces are small, so few steps suffice.
    """
    inner = mask.astype(float)

    def operator(u):
        u = np.pad(u, 1)
        return inner * (4 * u[1:-1, 1:-1] - u[:-2, 1:-1] - u[2:, 1:-1] - u[1:-1, :-2] - u[1:-1, 2:])

    u = np.zeros(mask.shape)
    residual = inner * 2
    direction, power = residual, (residual**2).sum()
    for _ in range(steps):
        image = operator(direction)
        step = power / max((direction * image).sum(), 1e-30)
        u, residual = u + step * direction, residual - step * image
        last, power = power, (residual**2).sum()
        direction = residual + power / max(last, 1e-30) * direction
    return np.sqrt(2 * np.maximum(u, 0)) / FINE


def normals(height):
    dy, dx = np.gradient(height * FINE)
    normal = np.stack([-dx, -dy, np.ones_like(dx)], -1)
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def highlight(normal, sharpness):
    """Blinn's highlight for a viewer straight above."""
    half = LIGHT + np.array([0, 0, 1])
    return np.clip(normal @ (half / np.linalg.norm(half)), 0, 1) ** sharpness


def lit(albedo, height, ambient=0.35, gloss=0.0, sharpness=30, hollow=6.0, depth=0.5):
    """Diffuse light, ambient light darkened in hollows about `hollow` wide, and a highlight."""
    normal = normals(height)
    diffuse = np.clip(normal @ LIGHT, 0, 1) / LIGHT[2]
    open_ = np.clip(1 + depth * (height - gaussian_filter(height, hollow * FINE / 2)) / hollow * 2, 0.15, 1.3)
    sky = np.array([0.92, 0.98, 1.08])
    sun = np.array([1.06, 1.0, 0.92])
    light = (1 - ambient) * diffuse[..., None] * sun + ambient * open_[..., None] * sky
    return albedo * light + gloss * highlight(normal, sharpness)[..., None]
