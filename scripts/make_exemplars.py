#!/usr/bin/python3
"""Draws the exemplars: small pictures of natural and test textures that the texture methods imitate.

    scripts/make_exemplars.py [--out scenes/exemplars] [names...]

Writes <name>.png (8-bit sRGB) and, where there is relief, <name>_height.png (16-bit grey, 0 lowest to 65535 highest) and, where
something glows, <name>_emission.png (8-bit sRGB, black where nothing does). The same version of this script always draws the same pictures: every exemplar has its own fixed seed.

Each exemplar is drawn in linear light on a grid three times as fine as its picture and box-filtered down; the tools for that
and the units are in exemplar_drawing.py.

Exit codes: 0 done, 2 usage, 4 the result cannot be written.
"""
import argparse
import os
import pathlib
import sys
import zlib

import numpy as np
import OpenImageIO as oiio
from scipy.ndimage import gaussian_filter

from exemplar_drawing import (
    FINE,
    LIGHT,
    cells,
    colour,
    fractal,
    grid,
    highlight,
    inflate,
    inside,
    lit,
    mix,
    noise,
    normals,
    packDiscs,
    palette,
    ramp,
    rounded,
    scatter,
    shoulder,
    smoothstep,
    toSrgb,
    warped,
)

MARGIN = 16  # pixels drawn beyond each edge and cropped, so that what the edge cuts has no rim there


# Each exemplar function returns the linear picture, its height (or None) and, if it glows, its emission, all on the fine grid.


def pebbles(rng, size):
    """Rounded stones packed like scales, dark gaps between them."""
    x, y = warped(rng, size, 16, 0.9)
    owner, edge = cells(scatter(rng, size, 20.5, 3), x, y)
    stone = rounded(edge > 1.05, 4.2)
    dome = inflate(stone)
    # A flatter top and a steeper rim than a dome: water-worn stone rather than a ball.
    height = 7.0 * (1 - np.exp(-dome / 5.0)) + 0.16 * fractal(rng, size, 7, 3) * smoothstep(0, 4, dome)

    count = owner.max() + 1
    kinds = palette("#b0765a", "#c3a06f", "#8d6252", "#74828a", "#939ca1", "#626b75", "#d3c3a4", "#9a8d7a", "#828b7c", "#a15f4b")
    chance = np.array([0.15, 0.14, 0.11, 0.12, 0.10, 0.08, 0.09, 0.09, 0.06, 0.06])
    tone = kinds[rng.choice(len(kinds), count, p=chance)] * rng.normal(1, 0.13, (count, 1)).clip(0.7, 1.35)
    tone = tone * rng.normal(1, 0.035, (count, 3))
    albedo = tone[owner]
    # Blotches inside a stone: each stone sees another part of the noise so that blotches stop at its rim.
    shift = rng.integers(0, size * FINE, (count, 2))
    row, column = np.indices(owner.shape)
    blotch = fractal(rng, size, 12, 3)[(row + shift[owner, 0]) % (size * FINE), (column + shift[owner, 1]) % (size * FINE)]
    albedo = albedo * (1 + 0.12 * blotch + 0.05 * noise(rng, size, 2.2))[..., None]
    rim = smoothstep(0, 3.2, inside(stone))
    albedo = albedo * (0.55 + 0.45 * rim)[..., None]

    ground = colour("#1d1612") * (1 + 0.25 * fractal(rng, size, 5, 2))[..., None]
    cover = stone.astype(float)
    picture = lit(mix(ground, albedo, cover), height, ambient=0.34, hollow=7, depth=0.9)
    shine = 0.27 * highlight(normals(gaussian_filter(height, 1.2 * FINE)), 14)
    return picture + (cover * shine * (1 + 0.10 * noise(rng, size, 2.2)))[..., None], height


def chocolate(rng, size):
    """Lumps of dark and milk chocolate in a dark mass. Not shaded: relief and glaze are the renderer's."""
    x, y = warped(rng, size, 18, 1.2)
    owner, edge = cells(scatter(rng, size, 22, 3), x, y)
    lump = rounded(edge > 1.0, 4.5)
    height = 7.0 * (1 - np.exp(-inflate(lump) / 4.5)) + 0.10 * fractal(rng, size, 9, 3)

    count = owner.max() + 1
    kinds = palette("#3a1f12", "#4b2a19", "#2b160d", "#6b3f25", "#8a5a38", "#55301c")
    tone = kinds[rng.choice(len(kinds), count, p=[0.26, 0.22, 0.16, 0.16, 0.08, 0.12])]
    tone = tone * rng.normal(1, 0.10, (count, 1)).clip(0.75, 1.3)
    albedo = tone[owner] * (1 + 0.08 * fractal(rng, size, 10, 3) + 0.03 * noise(rng, size, 2.2))[..., None]
    mass = colour("#1d0e08") * (1 + 0.15 * fractal(rng, size, 6, 2))[..., None]
    return mix(mass, albedo, smoothstep(0, 2.6, inside(lump))), height


def lavaCrust(rng, size):
    """Dark plates of crust, drifting apart over glowing lava."""
    x, y = warped(rng, size, 30, 2.2)
    x, y = x + 0.7 * noise(rng, size, 9), y + 0.7 * noise(rng, size, 9)
    points = scatter(rng, size, 23, 2)
    owner, edge = cells(points, x, y)
    # Cracks open and close along the surface: the same edge is a wide river here and a hairline there.
    opening = np.clip(1.15 + 0.7 * noise(rng, size, 45), 0.3, 2.8)
    plate = rounded(edge > opening, 1.2)
    rise = inflate(plate)
    crust = 2.4 * (1 - np.exp(-rise / 2.2))
    count = len(points)
    # Ropes: folds that run at another angle on every plate.
    angle = rng.uniform(0, np.pi, count)[owner]
    along = (x * np.cos(angle) + y * np.sin(angle)) + 1.8 * noise(rng, size, 18)
    rope = np.sin(2 * np.pi * along / 5.5) * (rng.random(count) < 0.6)[owner]
    relief = 0.42 * rope * smoothstep(1, 5, rise) + 0.55 * fractal(rng, size, 13, 3)
    height = crust + relief * plate + rng.uniform(0, 1.6, count)[owner] * smoothstep(0, 2.5, inside(plate))
    tone = palette("#2b2624", "#3a3330", "#221f20", "#443834")[rng.integers(0, 4, count)][owner]
    picture = lit(tone * (1 + 0.12 * fractal(rng, size, 10, 3))[..., None], height, ambient=0.3, gloss=0.05, sharpness=12, hollow=5, depth=0.8)

    outside = inside(~plate)
    heat = np.clip(0.10 + 0.28 * np.minimum(opening, 1.3) + 0.30 * outside / 1.6 + 0.14 * noise(rng, size, 40) + 0.06 * fractal(rng, size, 8, 3), 0, 1)
    fire = ramp(palette("#2a0500", "#7d1200", "#d93a02", "#ff8a10", "#ffd75a", "#fff3bf"), heat) * (0.75 + 0.55 * heat)[..., None]
    picture = np.where(plate[..., None], picture, fire)
    # Rims catch the glow of the crack beside them.
    glow = gaussian_filter(np.where(plate, 0, heat**2), 1.8 * FINE)
    # The glow on the rims is the cracks' light on them and no light of their own.
    return picture + colour("#ff4a08") * (0.9 * glow * plate)[..., None], height, fire * ~plate[..., None]


def foam(rng, size):
    """Bubbles of several sizes pressed against each other on pale liquid."""
    radii = np.concatenate([rng.uniform(11, 15, 120), rng.uniform(6.5, 11, 480), rng.uniform(3.2, 6.5, 1300), rng.uniform(1.6, 3.2, 2600)])
    centres, sizes = packDiscs(rng, size, radii, 0.32)
    x, y = warped(rng, size, 24, 0.5)
    best = np.full(x.shape, np.inf)
    second = np.full(x.shape, np.inf)
    owner = np.zeros(x.shape, int)
    # Power diagram: where two bubbles touch the wall between them is straight, as in real foam.
    for k, (centre, radius) in enumerate(zip(centres, sizes)):
        reach = int((radius + 14) * FINE)
        c, r = (centre * FINE).astype(int)
        window = np.s_[max(r - reach, 0) : max(r + reach, 0), max(c - reach, 0) : max(c + reach, 0)]
        power = (x[window] - centre[0]) ** 2 + (y[window] - centre[1]) ** 2 - radius**2
        closer = power < best[window]
        second[window] = np.where(closer, best[window], np.minimum(second[window], power))
        best[window] = np.where(closer, power, best[window])
        owner[window] = np.where(closer, k, owner[window])
    radius = sizes[owner]
    away = np.stack([x, y], -1) - centres[owner]
    free = radius - np.linalg.norm(away, axis=-1)
    wall = np.minimum(free, (second - best) / (2.2 * radius))
    bubble = wall > 0
    depth = np.clip(wall / radius, 0, 1)

    liquid = mix(colour("#7fb2bd"), colour("#a9d0d2"), smoothstep(-1.5, 1.5, noise(rng, size, 50)))
    floor = mix(colour("#5f9aa8"), colour("#cfe6e4"), smoothstep(-1, 1, (rng.standard_normal(len(sizes)) * 0.8)[owner] + 0.5 * noise(rng, size, 40)))
    inner = mix(floor * 1.05, floor * 0.72, smoothstep(0.0, 0.5, depth))
    # Light falls in at the top left and gathers on the bubble's floor at the far side.
    toLight = (away @ LIGHT[:2]) / radius / np.linalg.norm(LIGHT[:2])
    inner = inner * (1 - 0.22 * toLight)[..., None]
    hue = rng.uniform(0, 2 * np.pi, len(sizes))[owner] + 7 * depth
    film = 0.05 * np.stack([np.cos(hue), np.cos(hue - 2.1), np.cos(hue + 2.1)], -1)
    inner = inner * (1 + 1.6 * film * (radius > 4)[..., None])
    rim = np.exp(-((wall - 0.75) / 0.55) ** 2)
    line = np.exp(-np.maximum(wall, 0) / 0.35)
    picture = np.where(bubble[..., None], mix(inner, colour("#f4fbfa"), 0.75 * rim), liquid * 0.9)
    picture = mix(picture, colour("#3e7482"), 0.55 * line * (radius > 2.4))

    # The sky's reflection: a bright arc inside the rim that faces it, a fainter one opposite, and the sun's glint.
    reach = np.linalg.norm(away, axis=-1) / radius
    facing = toLight / np.maximum(reach, 1e-6)
    ring = np.exp(-(((reach - 0.74) / 0.10) ** 2)) * bubble
    glint = np.exp(-((away / radius[..., None] + np.array([0.36, 0.40])) ** 2).sum(-1) / 0.11**2) * bubble
    shine = 0.75 * ring * smoothstep(0.72, 1.0, facing) + 0.35 * ring * smoothstep(0.78, 1.0, -facing) + 0.9 * glint
    height = np.where(bubble, np.sqrt(np.clip(1 - (1 - depth) ** 2, 0, 1)) * radius, 0)
    return picture + (shine * smoothstep(1.8, 4.5, radius))[..., None], height


def ripples(rng, size):
    """Wind ripples on sand, with the forks real ones have."""
    wavelength = 19.0
    samples = size * FINE
    fy, fx = np.meshgrid(np.fft.fftfreq(samples, 1 / FINE), np.fft.fftfreq(samples, 1 / FINE), indexing="ij")
    angle = np.radians(62)
    along, across = fx * np.cos(angle) + fy * np.sin(angle), -fx * np.sin(angle) + fy * np.cos(angle)
    band = np.exp(-(((along - 1 / wavelength) / 0.0085) ** 2) - (across / 0.0125) ** 2)
    wave = np.fft.ifft2(np.fft.fft2(rng.standard_normal((samples, samples))) * band)
    phase = np.angle(wave) + 0.16 * noise(rng, size, 16)
    # At a fork the phase has no value; the ripple dies down there.
    strength = np.abs(wave) / np.abs(wave).mean()
    strength = strength / np.sqrt(strength**2 + 0.06)
    # Gentle windward slope, steep lee.
    profile = np.sin(phase + 0.55 * np.sin(phase)) * (1 + 0.10 * noise(rng, size, 40)) * strength
    height = 2.5 * gaussian_filter(profile, 0.5 * FINE) + 0.05 * fractal(rng, size, 5, 3)
    sand = ramp(palette("#8a6440", "#c29a66", "#dcbc88"), 0.5 + 0.28 * profile + 0.08 * noise(rng, size, 60))
    grain = 1 + 0.07 * noise(rng, size, 1.7) + 0.03 * noise(rng, size, 4)
    sparse = noise(rng, size, 2.2)
    sand = mix(sand, colour("#4c3626"), 0.5 * smoothstep(2.3, 2.9, sparse))
    return lit(sand * grain[..., None], height, ambient=0.38, hollow=8, depth=0.8), height


def checker(rng, size):
    """A two-tone checker; every tile is tinted a little differently, so that a shift by a period can be told."""
    x, y = grid(size)
    tile = 16
    column, row = (x // tile).astype(int), (y // tile).astype(int)
    count = size // tile
    dark = palette("#27425f", "#2b5363", "#3a3d66", "#1f3a4c", "#44385c")[rng.integers(0, 5, (count, count))]
    light = palette("#f0e4cc", "#eadcc6", "#f3d9bd", "#e4e2cf", "#f2e6d9")[rng.integers(0, 5, (count, count))]
    tone = np.where(((np.arange(count)[:, None] + np.arange(count)) % 2 == 0)[..., None], dark, light)
    return tone[row, column] * rng.normal(1, 0.06, (count, count, 1)).clip(0.85, 1.15)[row, column], None


def soup(rng, size):
    """Globules of fat on clear broth, a few of them run together, and flecks of herb."""
    x, y = warped(rng, size, 30, 0.8)
    radii = np.concatenate([rng.uniform(11, 15, 45), rng.uniform(6.5, 10, 130), rng.uniform(3, 6, 330), rng.uniform(1.3, 2.6, 420)])
    centres, sizes = packDiscs(rng, size, radii, -0.14)
    field = np.zeros(x.shape)
    for centre, radius in zip(centres, sizes):
        squared = ((x - centre[0]) ** 2 + (y - centre[1]) ** 2) / radius**2
        # Falls to nothing at 1.3 radii: near neighbours bridge, others stay apart.
        field += np.where(squared < 1.69, (1 - squared / 1.69) ** 2, 0) / (1 - 1 / 1.69) ** 2
    fat = field > 1
    lens = inflate(fat)
    height = 5 * (1 - np.exp(-lens / 7))
    broth = ramp(palette("#6b3208", "#99530f", "#bd7a24"), 0.5 + 0.22 * noise(rng, size, 70) + 0.10 * fractal(rng, size, 26, 3))
    broth = broth * (1 - 0.35 * smoothstep(1.9, 2.6, fractal(rng, size, 6, 2)))[..., None]
    # A globule is a lens: it shades the broth at its lower right and gathers the light inside its far rim.
    shift = int(1.7 * FINE)
    shadow = gaussian_filter(np.roll(fat.astype(float), (shift, shift), (0, 1)), 1.0 * FINE)
    broth = broth * (1 - 0.45 * shadow * ~fat)[..., None]
    normal = normals(height)
    away = -(normal[..., :2] @ LIGHT[:2]) / np.linalg.norm(LIGHT[:2])
    rim = inside(fat)
    body = mix(colour("#c98a2c"), colour("#e2ab48"), smoothstep(0, 9, lens)) * (1 + 0.06 * noise(rng, size, 24))[..., None]
    gathered = smoothstep(0.0, 0.55, away) * np.exp(-(((rim - 1.7) / 1.5) ** 2))
    body = body * np.clip(0.90 + 0.75 * away, 0.35, 1.6)[..., None] + colour("#ffd98a") * (0.55 * gathered)[..., None]
    body = mix(body, colour("#7a3d0a"), 0.65 * np.exp(-rim / 0.5))
    picture = np.where(fat[..., None], body, broth)
    picture = picture + (fat * (0.85 * highlight(normal, 160) + 0.14 * highlight(normal, 18)))[..., None]

    herbs = palette("#47702a", "#5f8a35", "#2f5420", "#6d9a48")
    for _ in range(int(70 * (size / 256) ** 2)):
        centre, turn = rng.uniform(0, size, 2), rng.uniform(0, np.pi)
        length, width = rng.uniform(2.2, 4.4), rng.uniform(1.0, 1.9)
        u = (x - centre[0]) * np.cos(turn) + (y - centre[1]) * np.sin(turn)
        v = -(x - centre[0]) * np.sin(turn) + (y - centre[1]) * np.cos(turn)
        shape = 1 - np.abs(u / length) ** 2.5 - np.abs((v - 0.12 * u**2 / length) / width) ** 2.5
        tone = herbs[rng.integers(4)] * (0.9 + 0.5 * np.clip((u * LIGHT[0] + v * LIGHT[1]) / width, -0.6, 0.6))[..., None]
        picture = mix(picture, picture * 0.6, 0.6 * (np.roll(shape, (2, 2), (0, 1)) > 0))
        picture = np.where((shape > 0)[..., None], tone, picture)
        height = np.where(shape > 0, np.maximum(height, 1.2), height)
    return picture, height


def leafLitter(rng, size):
    """Fallen leaves lying over each other."""
    samples = size * FINE
    picture = np.tile(colour("#1c130c"), (samples, samples, 1))
    height = np.zeros((samples, samples))
    kinds = palette("#a8551c", "#c67a22", "#8a3a16", "#d69a3a", "#74491f", "#9c6b34", "#b8452a", "#7d7a32", "#5f3a1c", "#caa052")
    leaves = int(1500 * (size / 256) ** 2)
    for k in range(leaves):
        top = k / leaves
        length = rng.uniform(11, 16)
        reach = int((length + 4) * FINE)
        centre = rng.integers(-reach // 2, samples + reach // 2, 2)
        rows = np.arange(max(centre[0] - reach, 0), min(centre[0] + reach, samples))
        columns = np.arange(max(centre[1] - reach, 0), min(centre[1] + reach, samples))
        if len(rows) == 0 or len(columns) == 0:
            continue
        window = np.ix_(rows, columns)
        px, py = (columns[None, :] - centre[1]) / FINE, (rows[:, None] - centre[0]) / FINE
        turn, bend, aspect, belly = rng.uniform(0, 2 * np.pi), rng.normal(0, 0.016), rng.uniform(0.34, 0.52), rng.uniform(-0.25, 0.25)
        teeth, toothed = rng.uniform(2.0, 2.8), rng.random() < 0.5

        def leaf(dx, dy):
            u = (px - dx) * np.cos(turn) + (py - dy) * np.sin(turn)
            v = -(px - dx) * np.sin(turn) + (py - dy) * np.cos(turn) - bend * u**2
            t = u / length
            outline = aspect * length * np.clip(1 - t**2, 0, None) ** 0.85 * (1 + belly * t)
            if toothed:
                outline = outline * (1 + 0.09 * np.abs(((u / teeth) % 1) - 0.5))
            stalk = (np.abs(v) < 0.45) & (t > -1.22) & (t < -0.9)
            return u, v, np.where(stalk, 0.4 - np.abs(v), outline - np.abs(v)), outline

        shadow = leaf(1.3, 1.4)[2]
        picture[window] *= (1 - 0.55 * smoothstep(-1.2, 0.8, shadow))[..., None]
        u, v, within, outline = leaf(0, 0)
        mask = within > 0
        tone = kinds[rng.integers(len(kinds))] * rng.normal(1, 0.14, 1).clip(0.65, 1.35) * rng.normal(1, 0.05, 3) * (0.72 + 0.28 * top)
        # The halves of a leaf tilt away from the midrib, so one of them faces the light more.
        facing = np.sign(v) * (np.cos(turn) * LIGHT[1] - np.sin(turn) * LIGHT[0])
        curl = np.abs(v) / np.maximum(outline, 0.5)
        shade = 1 + facing * (0.20 + 0.22 * curl) - 0.10 * curl**2
        side = (u - 0.9 * np.abs(v)) / rng.uniform(2.4, 3.2)
        vein = np.exp(-(((side % 1) - 0.5) / 0.13) ** 2) * smoothstep(0.4, 1.6, within)
        midrib = np.exp(-((v / 0.42) ** 2)) * (u < 0.93 * length)
        body = tone * shade[..., None]
        if rng.random() < 0.35:
            body = mix(body, body * np.array([0.55, 0.45, 0.40]), smoothstep(0.5, 0.95, np.abs(u) / length))
        body = mix(body, body * 0.74, 0.7 * vein)
        body = mix(body, tone * 1.35 + 0.04, 0.75 * midrib)
        picture[window] = np.where(mask[..., None], body, picture[window])
        lift = top * 8 + 1.1 * np.sqrt(np.clip(within / (aspect * length), 0, 1)) + 0.35 * midrib
        height[window] = np.where(mask, lift, height[window])
    return picture * (1 + 0.035 * noise(rng, size, 2.2))[..., None] * 1.12, height


def squares(rng, size):
    """Coloured squares of several sizes, thrown on top of each other a little askew."""
    x, y = grid(size)
    picture = np.tile(colour("#26292e"), x.shape + (1,))
    height = np.zeros(x.shape)
    kinds = palette("#d1493f", "#e8a33b", "#f0d65a", "#6fae5b", "#3f8fa6", "#345c9c", "#7a4f94", "#e6e0d2", "#d98ba0", "#3b3f46")
    places = np.concatenate([scatter(rng, size, 15, 4), scatter(rng, size, 19, 3)])
    for k, centre in enumerate(places):
        half, turn = rng.choice([5.5, 7.5, 9.5, 11.5], p=[0.25, 0.35, 0.28, 0.12]), rng.normal(0, 0.16)
        r0, r1, c0, c1 = (int(np.clip(v * FINE, 0, size * FINE)) for v in (centre[1] - 20, centre[1] + 20, centre[0] - 20, centre[0] + 20))
        if min(r1 - r0, c1 - c0) < 2:
            continue
        window = np.s_[r0:r1, c0:c1]

        def distance(shift, corner=1.2):
            dx, dy = x[window] - centre[0] - shift, y[window] - centre[1] - shift
            u, v = np.abs(dx * np.cos(turn) + dy * np.sin(turn)), np.abs(dy * np.cos(turn) - dx * np.sin(turn))
            qu, qv = u - half + corner, v - half + corner
            return np.hypot(np.maximum(qu, 0), np.maximum(qv, 0)) + np.minimum(np.maximum(qu, qv), 0) - corner

        picture[window] *= (1 - 0.55 * smoothstep(1.5, -1.2, distance(1.2)))[..., None]
        d = distance(0)
        tone = kinds[rng.integers(len(kinds))] * rng.normal(1, 0.1, 1).clip(0.75, 1.25)
        bevel = 0.9 * smoothstep(0, 1.6, -d)
        picture[window] = np.where((d < 0)[..., None], lit(tone, bevel, ambient=0.4, depth=0), picture[window])
        height[window] = np.where(d < 0, 0.02 * k / len(places) * 100 + bevel, height[window])
    return picture * (1 + 0.03 * noise(rng, size, 2.5))[..., None], height


def battal(rng, size):
    """Marbled paper: drops of colour let fall on the bath one after another, each pushing the earlier ones aside."""
    x, y = warped(rng, size, 60, 1.6)
    inks = palette("#1f3b5c", "#a33b2e", "#e9dfc8", "#2f6d68", "#d49a3c", "#54324f", "#e9dfc8")
    drops = int(900 * (size / 256) ** 2)
    centres = rng.uniform(-50, size + 50, (drops, 2))
    radii = np.exp(rng.normal(np.log(8.5), 0.42, drops)).clip(3, 18)
    ink = rng.integers(0, len(inks), drops)
    picture = np.tile(colour("#e9dfc8"), x.shape + (1,))
    bound = np.zeros(x.shape, bool)
    # Last drop first: a sample inside it shows its ink; any other is moved to where it lay before that drop fell.
    for centre, radius, kind in list(zip(centres, radii, ink))[::-1]:
        dx, dy = x - centre[0], y - centre[1]
        squared = dx**2 + dy**2
        hit = (squared < radius**2) & ~bound
        picture[hit] = inks[kind]
        bound |= hit
        pull = np.sqrt(np.clip(1 - radius**2 / np.maximum(squared, 1e-9), 0, 1))
        x, y = centre[0] + dx * pull, centre[1] + dy * pull
    return picture * (1 + 0.05 * noise(rng, size, 30) + 0.025 * noise(rng, size, 2.5))[..., None], None


def scales(rng, size):
    """A reptile's scales: shields that lie over each other like tiles, each with a rim and a low keel."""
    samples = size * FINE
    centres = scatter(rng, size, 17.5, 6)
    # The tail end first, so that the tip of every scale covers the heads of those behind it.
    centres = centres[np.argsort(-centres[:, 1])]
    bend, tint, moss = noise(rng, size, 110), noise(rng, size, 60), noise(rng, size, 90)
    speckle = fractal(rng, size, 4.5, 3)
    kinds = palette("#2c3d1c", "#485f24", "#6b7a33", "#8a8042", "#77602f", "#4a3a22")
    albedo = np.tile(colour("#15140c"), (samples, samples, 1))
    height = np.zeros((samples, samples))
    reach = int(17 * FINE)
    for centre in centres:
        column, row = (centre * FINE).astype(int)
        at = tuple(np.clip((row, column), 0, samples - 1))
        turn = 0.22 * bend[at] + rng.normal(0, 0.07)
        half = np.array([12.6, 10.4]) * rng.normal(1, 0.05, 2).clip(0.88, 1.12)
        shade = np.clip(0.46 + 0.19 * tint[at] + rng.normal(0, 0.10), 0, 1)
        tone = ramp(kinds, shade) * rng.normal(1.0, 0.11) * rng.normal(1, 0.02, 3)
        window = np.s_[max(row - reach, 0) : max(row + reach, 0), max(column - reach, 0) : max(column + reach, 0)]
        y, x = np.indices(albedo[window].shape[:2])
        px = (x + window[1].start + 0.5) / FINE - centre[0]
        py = (y + window[0].start + 0.5) / FINE - centre[1]
        # u from head to tip, v across; the tip is narrower than the shoulders.
        u, v = py * np.cos(turn) + px * np.sin(turn), px * np.cos(turn) - py * np.sin(turn)
        width = half[1] * (1 - 0.20 * smoothstep(-2, half[0], u))
        p = 2.3
        outline = (np.abs(u / half[0]) ** p + np.abs(v / width) ** p) ** (1 / p)
        edge = (1 - outline) * 11.5
        mask = edge > 0
        along = np.clip((u / half[0] + 1) / 2, 0, 1)
        keel = np.exp(-((v / 1.5) ** 2)) * smoothstep(0.25, 0.6, along) * smoothstep(0.5, 4.5, edge)
        lip = np.exp(-(((edge - 1.5) / 0.8) ** 2))
        dome = 1 - np.exp(-np.maximum(edge, 0) / 2.6)
        rise = 5.2 * along * (0.35 + 0.65 * dome) + 2.2 * dome + 0.5 * lip + 0.9 * keel
        body = tone * (0.80 + 0.30 * smoothstep(0.1, 0.75, along) + 0.10 * speckle[window])[..., None]
        body = mix(body, tone * 1.45 + 0.03, 0.45 * keel)
        body = mix(body, colour("#d3c684") * (0.8 + 0.4 * shade), 0.62 * lip * smoothstep(0.35, 0.7, along))
        body = body * (0.22 + 0.78 * smoothstep(-0.2, 1.2, edge))[..., None]
        albedo[window] = np.where(mask[..., None], body, albedo[window])
        height[window] = np.where(mask, rise, height[window])
    albedo = albedo * (1 + 0.07 * moss + 0.04 * noise(rng, size, 2.0))[..., None]
    height = gaussian_filter(height, 0.35 * FINE) + 0.10 * speckle
    picture = lit(albedo, height, ambient=0.36, hollow=6, depth=0.9)
    return picture + (0.20 * highlight(normals(gaussian_filter(height, 0.9 * FINE)), 22))[..., None], height


EXEMPLARS = {
    "pebbles": (pebbles, 384),
    "lava_crust": (lavaCrust, 256),
    "foam": (foam, 256),
    "ripples": (ripples, 256),
    "checker": (checker, 256),
    "soup": (soup, 256),
    "leaf_litter": (leafLitter, 256),
    "squares": (squares, 256),
    "battal": (battal, 256),
    "scales": (scales, 256),
    "chocolate": (chocolate, 256),
}


def coarse(field):
    """Crops the margin and box-filters the fine grid to pixels."""
    field = field[MARGIN * FINE : -MARGIN * FINE, MARGIN * FINE : -MARGIN * FINE]
    size = field.shape[0] // FINE
    return field.reshape(size, FINE, size, FINE, *field.shape[2:]).mean((1, 3))


def writePng(path, values):
    """Writes 8- or 16-bit integers beside the target and renames."""
    temporary = path.with_name(f"{path.stem}.tmp.{os.getpid()}.png")
    values = np.atleast_3d(values)
    spec = oiio.ImageSpec(values.shape[1], values.shape[0], values.shape[2], str(values.dtype))
    spec.attribute("png:compressionLevel", 9)
    spec.attribute("oiio:ColorSpace", "sRGB" if values.dtype == np.uint8 else "linear")
    try:
        output = oiio.ImageOutput.create(str(temporary))
        if not output or not output.open(str(temporary), spec) or not output.write_image(values) or not output.close():
            raise OSError(output.geterror() if output else oiio.geterror())
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def draw(name, out):
    function, size = EXEMPLARS[name]
    picture, height, *emission = function(np.random.default_rng(zlib.crc32(name.encode())), size + 2 * MARGIN)
    for suffix, light in zip(("", "_emission"), (picture, *emission)):
        writePng(out / f"{name}{suffix}.png", np.round(toSrgb(coarse(shoulder(light))) * 255).astype(np.uint8))
    if height is not None:
        height = coarse(height)
        height = (height - height.min()) / (height.max() - height.min())
        writePng(out / f"{name}_height.png", np.round(height * 65535).astype(np.uint16))


def main():
    parser = argparse.ArgumentParser(prog="make_exemplars.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="of " + ", ".join(EXEMPLARS) + " (default: all)")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("scenes/exemplars"), help="folder (default %(default)s)")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.names if name not in EXEMPLARS]
    if unknown:
        parser.error(f"names: got {', '.join(unknown)}, expected some of: {', '.join(EXEMPLARS)}")
    try:
        arguments.out.mkdir(parents=True, exist_ok=True)
        for name in arguments.names or EXEMPLARS:
            draw(name, arguments.out)
            print(name)
    except OSError as error:
        print(f"make_exemplars.py: {arguments.out}: cannot write: {error}", file=sys.stderr)
        sys.exit(4)


if __name__ == "__main__":
    main()
