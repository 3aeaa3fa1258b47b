"""The exemplar window nearest to a given one, over all positions and angles.

Dense candidates: every second position at 7.5 degrees, both sides softened and thinned to every second sample, in the space of
their principal components; the best of each 16 x 16 texel tile. The nearest are then refined on the full windows, first to a
texel and 4 degrees, the best of those to half a texel and 2 degrees.
"""

import cv2
import numpy as np

ANGLES = 48
COMPONENTS = 24
TILE = 8  # coarse positions a side
COARSE, FINE = 24, 6  # candidates refined per window
MAX_STEPS = 8
_OUTSIDE = 1e6  # squared distance of what is no window
_SOFT = np.outer([1, 2, 1], [1, 2, 1]).astype(np.float32) / 16


def _soft(image):
    return cv2.filter2D(image, -1, _SOFT, borderType=cv2.BORDER_REPLICATE)


class WindowSearch:
    """@param luma  H x W float32  @param side  samples a side of a window, odd"""

    def __init__(self, luma, side):
        self.luma = np.ascontiguousarray(luma, np.float32)
        self.side = side
        self._taps = 2 * np.arange(-((side // 2 - 1) // 2), (side // 2 - 1) // 2 + 1)
        steps = np.arange(side) - side // 2
        self._columns, self._rows = (a.astype(np.float32) for a in np.meshgrid(steps, steps))
        self._build()

    def reach(self, angles):
        """How far the windows' centres must be from the exemplar's border, texels."""
        return 0.5 + self.side // 2 * (np.abs(np.cos(angles)) + np.abs(np.sin(angles)))

    def _inside(self, at):
        height, width = self.luma.shape
        reach = self.reach(at[..., 2])
        return ((at[..., 0] >= reach) & (at[..., 1] >= reach) & (at[..., 0] <= width - reach)
                & (at[..., 1] <= height - reach))

    def _centres(self, angle):
        """@return (rows x columns, a multiple of TILE each) x 2: texels, about the exemplar's middle, in turned rows"""
        height, width = self.luma.shape
        c, s = abs(np.cos(angle)), abs(np.sin(angle))
        across = int(np.ceil((c * width + s * height) / 2 / TILE)) * TILE
        down = int(np.ceil((s * width + c * height) / 2 / TILE)) * TILE
        x, y = np.meshgrid(2 * (np.arange(across) - (across - 1) / 2), 2 * (np.arange(down) - (down - 1) / 2))
        c, s = np.cos(angle), np.sin(angle)
        return np.stack([width / 2 + c * x - s * y, height / 2 + s * x + c * y], axis=-1)

    def _build(self):
        soft = _soft(self.luma)
        pad = len(self._taps) // 2
        grids = []  # per angle: thinned windows as views, centres, inside
        for angle in 2 * np.pi * np.arange(ANGLES) / ANGLES:
            centres = self._centres(angle)
            inside = self._inside(np.concatenate([centres, np.full((*centres.shape[:2], 1), angle)], axis=-1))
            if not inside.any():
                continue
            # The turned exemplar at every second texel, with the border its outermost windows reach into.
            x, y = (np.pad(centres[..., i], pad, mode="reflect", reflect_type="odd").astype(np.float32) for i in (0, 1))
            turned = cv2.remap(soft, x - 0.5, y - 0.5, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
            side = len(self._taps)
            views = np.lib.stride_tricks.sliding_window_view(turned, (side, side))
            grids.append((angle, centres, inside, views))
        if not grids:
            raise ValueError("the exemplar is smaller than a window")
        rng = np.random.default_rng(0)
        sample = np.concatenate([views[inside][rng.integers(inside.sum(), size=500)] for _, _, inside, views in grids])
        sample = sample.reshape(len(sample), -1).astype(np.float64)
        self._mean = sample.mean(0)
        _, _, axes = np.linalg.svd(sample - self._mean, full_matrices=False)
        self._axes = axes[:COMPONENTS].T.astype(np.float32)
        # A tile is 64 rows of (components, their squared length): the distance to a query q, less |q|^2, is their product
        # with (-2 q, 1).
        rows, places = [], []
        for angle, centres, inside, views in grids:
            components = self._components(views.reshape(inside.size, -1)).reshape(*inside.shape, -1)
            squares = np.where(inside, (components**2).sum(-1), _OUTSIDE)
            rows.append(self._tiles(np.concatenate([components, squares[..., None]], axis=-1).astype(np.float32)))
            places.append(self._tiles(np.concatenate([centres, np.full((*inside.shape, 1), angle)], axis=-1)))
        self._rows_of_tiles, self._places = np.concatenate(rows), np.concatenate(places).astype(np.float32)

    @staticmethod
    def _tiles(grid):
        """@param grid  rows x columns x C  @return tiles x TILE^2 x C"""
        rows, columns, depth = grid.shape
        tiled = grid.reshape(rows // TILE, TILE, columns // TILE, TILE, depth).swapaxes(1, 2)
        return np.ascontiguousarray(tiled.reshape(-1, TILE * TILE, depth))

    def _components(self, thinned):
        return (thinned.reshape(len(thinned), -1) - self._mean.astype(np.float32)) @ self._axes

    def _candidates(self, windows):
        """@return N x K x 3: column, row, angle"""
        soft = np.stack([_soft(w) for w in windows])
        middle = self.side // 2
        queries = self._components(soft[:, middle + self._taps][:, :, middle + self._taps])
        queries = np.concatenate([-2 * queries, np.ones((len(queries), 1), np.float32)], axis=1)
        tiles = self._rows_of_tiles
        block = 128
        products = np.empty((block * TILE * TILE, len(queries)), np.float32)
        nearest = np.empty((len(tiles), len(queries)), np.float32)
        for i in range(0, len(tiles), block):
            part = tiles[i : i + block]
            d = np.matmul(part.reshape(-1, part.shape[-1]), queries.T, out=products[: part.shape[0] * part.shape[1]])
            nearest[i : i + block] = d.reshape(*part.shape[:2], -1).min(axis=1)
        keep = np.argpartition(nearest.T, min(COARSE, len(tiles) - 1), axis=1)[:, :COARSE]
        d = np.einsum("nktc,nc->nkt", tiles[keep], queries)
        return np.take_along_axis(self._places[keep], d.argmin(axis=2)[..., None, None], axis=2)[:, :, 0]

    def distances(self, windows, at):
        """@param windows  N x side x side  @param at  N x 3  @return N: mean squared difference; infinite if not inside"""
        c, s = np.cos(at[:, 2, None, None]).astype(np.float32), np.sin(at[:, 2, None, None]).astype(np.float32)
        x = (at[:, 0, None, None] - 0.5).astype(np.float32) + c * self._columns - s * self._rows
        y = (at[:, 1, None, None] - 0.5).astype(np.float32) + s * self._columns + c * self._rows
        found = np.empty(x.shape, np.float32)
        # remap takes at most 32767 rows.
        rows = 32000 // self.side
        for i in range(0, len(at), rows):
            part = slice(i, i + rows)
            shape = (-1, self.side)
            found[part] = cv2.remap(self.luma, x[part].reshape(shape), y[part].reshape(shape), cv2.INTER_CUBIC,
                                    borderMode=cv2.BORDER_REPLICATE).reshape(x[part].shape)
        d = ((found - windows) ** 2).mean(axis=(1, 2))
        return np.where(self._inside(at), d, np.inf)

    def _refine(self, windows, at, best, step, angle_step):
        """Moves every candidate to the better neighbour along each axis until none is. Changes `at`, `best`."""
        active = np.arange(len(at))
        for _ in range(MAX_STEPS):
            moved = np.zeros(len(active), bool)
            for axis, size in ((0, step), (1, step), (2, angle_step)):
                for sign in (-1, 1):
                    tried = at[active].copy()
                    tried[:, axis] += sign * size
                    d = self.distances(windows[active], tried)
                    better = d < best[active]
                    at[active[better]], best[active[better]] = tried[better], d[better]
                    moved |= better
            active = active[moved]
            if len(active) == 0:
                return

    def nearest(self, windows):
        """@param windows  N x side x side  @return N: RMS difference, N x 3: column, row, angle of the nearest"""
        if len(windows) == 0:
            return np.zeros(0), np.zeros((0, 3))
        windows = np.ascontiguousarray(windows, np.float32)
        at = self._candidates(windows).astype(float)
        for count, step, angle_step in ((COARSE, 1.0, np.radians(4)), (FINE, 0.5, np.radians(2))):
            n, k = at.shape[:2]
            flat = np.ascontiguousarray(at.reshape(n * k, 3))
            repeated = np.repeat(windows, k, axis=0)
            best = self.distances(repeated, flat)
            self._refine(repeated, flat, best, step, angle_step)
            order = np.argsort(best.reshape(n, k), axis=1, kind="stable")[:, : (FINE if count == COARSE else 1)]
            at = np.take_along_axis(flat.reshape(n, k, 3), order[..., None], axis=1)
            best = np.take_along_axis(best.reshape(n, k), order, axis=1)
        return np.sqrt(best[:, 0]), at[:, 0]
