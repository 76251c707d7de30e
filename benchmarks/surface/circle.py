#!/usr/bin/env python3
"""circle.py SLIPFIT [--count 200] [--others 60] [--seed 1] [--jobs 2]: force trace and worn track of one motion, and of different ones.

Each pair is simulated from one stick-slip motion: static friction scatters from slip to slip, the force rises with k V in between and falls along half
a cosine. The track is worn over the same path: a ridge from slip to slip that leans against the sliding, deeper the longer the stick, over several passes whose
phase wanders, with roughness, the tip of the instrument and form. `slipfit fit --surface` has to find them alike: E_n within 1 in 95 %. Of the others the
surface is of another motion (another spacing, twice, three times): E_n beyond 1. Shares no code with slipfit. Needs numpy."""
import collections
import pathlib
import sys
import tempfile

import numpy as np

import profiles

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from study import Row, counts, in_parallel, is_answer, median, parser, print_table, run, share, total  # noqa: E402


class Motion:
    """Stick-slip without damping: F_s of each slip scatters, and the slip ends as far below F_k as it began above it."""

    def __init__(self, rng):
        self.speed = float(np.exp(rng.uniform(np.log(1e-3), np.log(0.05))))
        self.stiffness = float(np.exp(rng.uniform(np.log(500), np.log(20000))))
        self.kinetic = rng.uniform(1, 5)
        self.excess = self.kinetic * rng.uniform(0.1, 0.5)  # F_s - F_k
        self.scatter = rng.uniform(0.01, 0.15)
        self.slip_share = rng.uniform(0.04, 0.12)  # of a period
        self.scale = 1.0

    def spacing_m(self):
        return self.scale * 2 * self.excess / self.stiffness / (1 - self.slip_share)

    def slips(self, rng, count):
        """Times of the onsets, peaks above F_k, duration of a slip."""
        peaks = self.excess * self.scale * np.clip(rng.normal(1, self.scatter, count + 1), 0.3, 1.7)
        slip_s = self.slip_share * self.spacing_m() / self.speed
        stick_s = (peaks[1:] + peaks[:-1]) / (self.stiffness * self.speed)
        onsets = np.cumsum(stick_s + slip_s)
        return onsets, peaks, slip_s


def force_trace(rng, motion, file):
    count = int(np.exp(rng.uniform(np.log(20), np.log(120))))
    onsets, peaks, slip_s = motion.slips(rng, count)
    step = slip_s / rng.uniform(6, 15)
    t = np.arange(int(onsets[-1] / step)) * step
    which = np.searchsorted(onsets, t)  # the slip that ends this stick
    force = motion.kinetic + peaks[which + 1] - motion.stiffness * motion.speed * (onsets[which] - t)
    before = which - 1
    since = t - np.where(before >= 0, onsets[np.maximum(before, 0)], -1e9)
    falling = since < slip_s
    force[falling] = motion.kinetic + peaks[np.maximum(before, 0) + 1][falling] * np.cos(np.pi * since[falling] / slip_s)
    force += rng.uniform(0.005, 0.05) * motion.excess * rng.standard_normal(len(t))
    force += rng.uniform(0, 0.3) * motion.excess * np.sin(2 * np.pi * t / t[-1] * rng.uniform(0.5, 2))
    np.savetxt(file, np.column_stack([t, force]), fmt="%.9g", delimiter=",", header="time_s,force_N", comments="")


def worn_track(rng, motion, file):
    count = int(np.exp(rng.uniform(np.log(20), np.log(150))))
    onsets, peaks, _ = motion.slips(rng, count + 2)
    edges = onsets * motion.speed
    pitch = motion.spacing_m() / rng.uniform(20, 80)
    x = edges[0] + np.arange(int((edges[-1] - edges[0]) / pitch)) * pitch
    z = np.zeros(len(x))
    passes = int(rng.integers(1, 5))
    for _ in range(passes):
        shifted = edges + motion.spacing_m() * rng.normal(0, 0.04)
        which = np.clip(np.searchsorted(shifted, x, "right") - 1, 0, len(edges) - 2)
        u = np.clip((x - shifted[which]) / (shifted[which + 1] - shifted[which]), 0, 1)
        dwell = (peaks[which + 1] + peaks[np.maximum(which, 0)]) / (2 * motion.excess * motion.scale)
        z += dwell / passes * profiles.ridge_height("saw", u)
    z = profiles.under_tip(z, 8 * (pitch / motion.spacing_m()) ** 2 / rng.uniform(0.05, 0.5))
    z += rng.uniform(0.02, 0.25) * profiles.smooth_noise(rng, len(z), rng.uniform(0, 3))
    t = np.linspace(-1, 1, len(z))
    z += rng.normal(0, 2) * t**2 + rng.normal(0, 2) * t
    np.savetxt(file, np.column_stack([(x - x[0]) * 1e3, z * rng.uniform(0.5, 20)]), fmt="%.9g", delimiter=",", header="x [mm],z [um]", comments="")


def compared(program, seed, number, scale):
    rng = np.random.default_rng([seed, number, int(100 * scale)])
    motion = Motion(rng)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        force_trace(rng, motion, folder / "force.csv")
        motion.scale = scale
        worn_track(rng, motion, folder / "track.csv")
        done = run(program, "fit", folder / "force.csv", "--speed", repr(motion.speed), "--surface", folder / "track.csv")
    return done["derived"] if is_answer(done) else {"surface_verdict": done.get("message", "")}


def main():
    words = parser(__doc__)
    words.add_argument("program")
    words.add_argument("--count", type=int, default=200)
    words.add_argument("--others", type=int, default=60)
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--jobs", type=int, default=2)
    given = words.parse_args()
    groups = collections.defaultdict(list)
    for scale, count in ((1.0, given.count), (0.7, given.others), (1.4, given.others), (2.0, given.others), (3.0, given.others)):
        for found in in_parallel(given.jobs, lambda i: compared(given.program, given.seed, i, scale), range(count)):
            score, ratio = (found.get("surface_En") or {}).get("value"), found.get("surface_ratio") or {}
            row = Row(pairs=1, compared=int(score is not None), verdicts=found.get("surface_verdict", "").split(":")[0][:45].replace(" ", "_"))
            row.add("|E_n| <= 1", None if score is None else int(abs(score) <= 1))
            row.add("reach %", 100 * np.log(ratio["ci95"][1] / ratio["value"]) if ratio.get("ci95") else None)
            groups[f"{scale:g}"].append(row)
    print_table({"pairs": total, "compared": total, "|E_n| <= 1": share, "reach %": median, "verdicts": counts}, groups, "surface over force", whole=None)


if __name__ == "__main__":
    main()
