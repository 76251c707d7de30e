#!/usr/bin/env python3
"""profiles.py OUT [--count 1000] [--controls 300] [--machined 60] [--seed 1]: simulated profiles and truth.jsonl.

Worn surfaces with a known spacing, and surfaces without one. Shares no code with slipfit. Needs numpy.

A profile is a dict: x_um, z_um (equal pitch), spacing_um (mean distance of the ridges; None for controls), family, and what was drawn.
"""
import json
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from study import parser  # noqa: E402

SHAPES = ("saw", "back", "sine", "arcs", "bumps", "blocks")


def ridge_height(shape, u):
    """Height over the place in the ridge, 0 <= u < 1, in heights of a ridge."""
    if shape == "saw":
        return np.where(u < 0.9, u / 0.9, (1.0 - u) / 0.1)
    if shape == "back":
        return np.where(u < 0.1, u / 0.1, (1.0 - u) / 0.9)
    if shape == "sine":
        return 0.5 - 0.5 * np.cos(2 * np.pi * u)
    if shape == "arcs":
        return np.sin(np.pi * u)
    if shape == "bumps":
        return np.exp(-0.5 * ((u - 0.5) / 0.12) ** 2)
    return np.clip(4 * np.minimum(u - 0.25, 0.75 - u) / 0.5 + 0.5, 0, 1)  # blocks with sloping sides


def spacings(rng, count, scatter):
    """Distances of ridges with mean 1 and the given coefficient of variation, all positive."""
    if scatter < 1e-3:
        return np.ones(count)
    if rng.random() < 0.5:
        return rng.gamma(1 / scatter**2, scatter**2, count)
    drawn = []
    while len(drawn) < count:  # symmetrical about 1, so that cutting both tails keeps the mean
        drawn.extend(d for d in rng.normal(1, scatter, count) if 0.15 < d < 1.85)
    return np.array(drawn[:count])


def smooth_noise(rng, n, width):
    """Unit variance, correlated over about so many samples."""
    if width < 1:
        return rng.standard_normal(n)
    reach = int(4 * width) + 1
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    noise = np.convolve(rng.standard_normal(n + 2 * reach), kernel, "valid")
    return noise / np.sqrt(np.sum(kernel**2))


def under_tip(z, curvature):
    """Highest place of a parabolic tip that touches the profile; curvature in heights over squared samples."""
    reach = min(len(z) // 4, int(np.sqrt(2 * (z.max() - z.min()) / curvature)) + 1, 200)
    out = z.copy()
    for k in range(1, reach + 1):
        drop = 0.5 * curvature * k * k
        out[k:] = np.maximum(out[k:], z[:-k] - drop)
        out[:-k] = np.maximum(out[:-k], z[k:] - drop)
    return out


def ridged(rng, count, scatter, shape, per_ridge, alternating=0.0):
    """Ridges from edge to edge over count mean spacings, samples from a random place in the first one."""
    widths = spacings(rng, int(1.3 * count) + 20, scatter)
    while widths.sum() < count + 2:
        widths = np.append(widths, spacings(rng, 20, scatter))
    edges = np.concatenate([[0], np.cumsum(widths)])
    n = int(count * per_ridge)
    x = rng.uniform(0.0, 1.0) + np.arange(n) / per_ridge
    which = np.searchsorted(edges, x, "right") - 1
    u = (x - edges[which]) / widths[which]
    heights = np.clip(rng.normal(1, rng.uniform(0, 0.3), len(widths)), 0.2, 2) * widths ** rng.uniform(0, 1)
    return ridge_height(shape, u) * heights[which], int(which.max() - which.min())


def pattern(rng):
    """A worn surface as issue says: shape, scatter 0-40 %, roughness 0-0.8 of the ridge, form, waviness, tip, pixel."""
    count = float(np.exp(rng.uniform(np.log(5.5), np.log(200))))
    per_ridge = float(np.exp(rng.uniform(np.log(10), np.log(min(200, 20000 / count)))))
    scatter = rng.uniform(0, 0.4) * (rng.random() < 0.85)
    shape = str(rng.choice(SHAPES))
    z, ridges = ridged(rng, count, scatter, shape, per_ridge)
    n = len(z)
    if rng.random() < 0.5:  # a tip that cannot reach the ground of the ridges fully
        z = under_tip(z, 8.0 / per_ridge**2 / rng.uniform(0.05, 1.0))
    roughness = rng.uniform(0, 0.8) * (rng.random() < 0.9)
    width = 0 if rng.random() < 0.5 else rng.uniform(0.02, 0.12) * per_ridge
    z = z + roughness * smooth_noise(rng, n, width)
    t = np.linspace(-1, 1, n)
    z = z + rng.normal(0, 3) * t**2 + rng.normal(0, 3) * t
    if rng.random() < 0.5:
        z = z + rng.uniform(0, 1.5) * smooth_noise(rng, n, min(n / 4, per_ridge * rng.uniform(2, 10)))
    height_um = np.exp(rng.uniform(np.log(0.3), np.log(30)))
    z = height_um * z
    if rng.random() < 0.3:
        step = (z.max() - z.min()) / 2 ** rng.integers(8, 13)
        z = np.round(z / step) * step
    spacing_um = float(np.exp(rng.uniform(np.log(10), np.log(1000))))
    return {"x_um": np.arange(n) * spacing_um / per_ridge, "z_um": z, "spacing_um": spacing_um, "family": shape,
            "scatter": scatter, "roughness": roughness, "count": count, "per_ridge": per_ridge, "rough_width": width / per_ridge}


CONTROLS = ("white", "gaussian", "exponential", "fractal", "waviness", "scratch", "ground", "odd_even", "scan_lines", "blocks8")


def control(rng, family):
    n = int(np.exp(rng.uniform(np.log(500), np.log(10000))))
    scale = float(np.exp(rng.uniform(np.log(2), np.log(n / 20))))
    rough = rng.standard_normal(n)
    if family == "white":
        z = rough
    elif family == "gaussian":
        z = smooth_noise(rng, n, scale) + 0.05 * rough
    elif family == "exponential":
        a = np.exp(-1 / scale)
        z = np.zeros(n)
        for i in range(1, n):
            z[i] = a * z[i - 1] + np.sqrt(1 - a * a) * rough[i]
    elif family == "fractal":
        f = np.fft.rfftfreq(n)
        f[0] = 1
        z = np.fft.irfft(np.fft.rfft(rough) * f ** -rng.uniform(0.6, 1.6), n)
        z /= z.std()
    elif family == "waviness":
        z = 3 * smooth_noise(rng, n, n / rng.uniform(8, 60)) + 0.3 * rough
    elif family == "scratch":
        at = rng.uniform(0.2, 0.8) * n
        z = smooth_noise(rng, n, rng.uniform(0, 6)) - rng.uniform(5, 40) * np.exp(-0.5 * ((np.arange(n) - at) / rng.uniform(3, 60)) ** 2)
    elif family == "ground":  # grooves of random depth and width at random places
        z = 0.1 * rough
        x = np.arange(n)
        for _ in range(int(n / scale) + 5):
            w = scale * rng.uniform(0.05, 0.6)
            z = z - rng.exponential(1) * np.exp(-0.5 * ((x - rng.uniform(0, n)) / w) ** 2)
    elif family == "odd_even":  # a pixel grid: every other sample set off
        z = smooth_noise(rng, n, rng.uniform(0, 8)) + rng.uniform(0.2, 2) * (np.arange(n) % 2)
    elif family == "scan_lines":  # levels of scan lines: steps at random places
        z = np.repeat(rng.standard_normal(n), rng.integers(1, 12, n))[:n] + 0.2 * rough
    else:  # blocks of eight: as coded by JPEG, each with its own mean and slope
        k = np.arange(n) // 8
        z = smooth_noise(rng, n, scale)
        step = rng.uniform(0.1, 0.5)
        z = step * np.round(z[np.minimum(8 * k + 4, n - 1)] / step) + 0.05 * rough
    t = np.linspace(-1, 1, n)
    z = z + rng.normal(0, 3) * t**2
    return {"x_um": np.arange(n) * 1.5, "z_um": z, "spacing_um": None, "family": family}


MACHINED = ("turned", "milled")


def machined(rng, family):
    """Marks of a tool: feed marks of a round tip in turning, cusps of a ball end mill. The feed keeps time; the spacing is true, but not of sliding."""
    count = float(np.exp(rng.uniform(np.log(8), np.log(150))))
    per_mark = float(np.exp(rng.uniform(np.log(12), np.log(100))))
    n = int(count * per_mark)
    t = rng.uniform(0, 1) + np.arange(n) / per_mark
    which = np.floor(t).astype(int)
    wander = rng.normal(0, rng.uniform(0, 0.02), which.max() + 3)  # of the feed
    u = np.clip(t - which - wander[which], 0, 1) - 0.5
    if family == "turned":
        z = 4 * u**2 * (1 + rng.normal(0, rng.uniform(0, 0.1), len(wander)))[which]
    else:  # deep cusps, whose height follows the run-out of the cutter's two edges
        z = 1 - np.sqrt(np.clip(1 - (1.6 * u) ** 2, 0, 1))
        z = z / z.max() * (1 + rng.uniform(0, 0.15) * (which % 2))
    z = z + rng.uniform(0.01, 0.3) * smooth_noise(rng, n, rng.uniform(0, 0.05) * per_mark)
    s = np.linspace(-1, 1, n)
    z = z + rng.normal(0, 2) * s**2
    spacing_um = float(np.exp(rng.uniform(np.log(30), np.log(500))))
    return {"x_um": np.arange(n) * spacing_um / per_mark, "z_um": 5 * z, "spacing_um": spacing_um, "family": family}


def write(profile, file):
    with open(file, "w", encoding="utf-8") as out:
        out.write("x [um],z [um]\n")
        np.savetxt(out, np.column_stack([profile["x_um"], profile["z_um"]]), fmt="%.9g", delimiter=",")


def main():
    words = parser(__doc__)
    words.add_argument("out", type=pathlib.Path)
    words.add_argument("--count", type=int, default=1000)
    words.add_argument("--controls", type=int, default=300)
    words.add_argument("--machined", type=int, default=60)
    words.add_argument("--seed", type=int, default=1)
    given = words.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    with open(given.out / "truth.jsonl", "w", encoding="utf-8") as truths:
        for i in range(given.count + given.controls + given.machined):
            rng, file = np.random.default_rng([given.seed, i]), f"{i:05d}.csv"
            if i < given.count:
                kind, made = "pattern", pattern(rng)
            elif i < given.count + given.controls:
                kind, made = "control", control(rng, CONTROLS[i % len(CONTROLS)])
            else:
                kind, made = "machined", machined(rng, MACHINED[i % len(MACHINED)])
            write(made, given.out / file)
            truth = {name: value for name, value in made.items() if name not in ("x_um", "z_um")}
            truths.write(json.dumps({"file": file, "kind": kind, **truth}) + "\n")


if __name__ == "__main__":
    main()
