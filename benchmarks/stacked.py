#!/usr/bin/env python3
"""What the terms of the model are worth on given recordings: a table, and pictures of stacked slips.

stacked.py table MANIFEST NEW [OLD]                       every recording of a manifest by one build or by two
stacked.py draw OUT.svg NEW FILE SPEED [OPTIONS] [-- OPTIONS] ...   one recording fitted with each group of options

Drawn are slip and stick, the stick less the straight line through it. A slip is stacked over its phase, 0 at the peak of the force and 1 at the trough, as the first build or fit counts
them: the mean of the force above the middle of the fall over the cycles, and the mean of what the fit leaves of it.
The stacked misfit is the root mean square of that mean between -0.15 and 1.15, over the mean fall of the force.
Drawing needs python3-matplotlib.
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy

from draw import save, use_matplotlib

BINS = 12
MARGIN = 0.15
TERMS = {"sensor_average_s": ("W", 1e3, "ms"), "slip_distance_m": ("D_c", 1e6, "um"), "reload_force_N": ("A", 1e3, "mN"),
         "reload_length_m": ("l", 1e3, "mm")}
STATED = {"speed_m_per_s": "--speed", "force_column": "--force-column", "sample_rate_Hz": "--sample-rate"}  # columns of a manifest
SHOWN = {"stiffness_N_per_m": "k", "natural_frequency_rad_per_s": "w_n", "damping_ratio": "zeta",
         "friction_difference_N": "dF"}


def fit(slipfit, file, *options):
    """The document of a fit, its curve (time, force, fitted) and the peaks and troughs that it counts."""
    with tempfile.TemporaryDirectory() as folder:
        out = {name: pathlib.Path(folder) / name for name in ("fit.json", "curve.csv", "cycles.csv")}
        subprocess.run([slipfit, "fit", file, "--json", "--quiet", "--out", out["fit.json"], "--curve", out["curve.csv"],
                        "--cycles", out["cycles.csv"], *options], check=False, capture_output=True)
        if not out["fit.json"].exists():
            return None
        document = json.loads(out["fit.json"].read_text())
        curve, slips = numpy.empty((0, 3)), []
        if out["curve.csv"].exists():
            curve = numpy.genfromtxt(out["curve.csv"], delimiter=",", skip_header=1, usecols=(0, 1, 2))
        if out["cycles.csv"].exists():
            with open(out["cycles.csv"], newline="") as lines:
                slips = [(float(row["peak_s"]), float(row["trough_s"])) for row in csv.DictReader(lines)
                         if row["used"] == "1"]
        return document, curve, slips


def stack(curve, slips, begin=-MARGIN, end=1.0 + MARGIN, bins=BINS):
    """Phase, mean force above the middle of the fall, mean fitted force above it; and the mean fall."""
    edges = numpy.linspace(begin, end, bins + 1)
    sums, counts, falls = numpy.zeros((2, bins)), numpy.zeros(bins), []
    for peak, trough in slips:
        near = curve[(curve[:, 0] >= peak + begin * (trough - peak)) & (curve[:, 0] <= peak + end * (trough - peak))]
        inside = near[(near[:, 0] >= peak) & (near[:, 0] <= trough)]
        near = near[numpy.isfinite(near[:, 2])]
        if len(inside) < 2 or not len(near):
            continue
        falls.append(inside[0, 1] - inside[-1, 1])
        place = numpy.clip(numpy.digitize((near[:, 0] - peak) / (trough - peak), edges) - 1, 0, bins - 1)
        middle = 0.5 * (inside[0, 1] + inside[-1, 1])
        for i in (0, 1):
            numpy.add.at(sums[i], place, near[:, 1 + i] - middle)
        numpy.add.at(counts, place, 1.0)
    if not falls:
        return None
    with numpy.errstate(invalid="ignore"):
        return 0.5 * (edges[1:] + edges[:-1]), sums[0] / counts, sums[1] / counts, float(numpy.mean(falls))


def stack_sticks(curve, slips, bins=30):
    """Phase between trough and next peak, and the means of force and fitted force there less the straight line through the stick."""
    sums, counts = numpy.zeros((2, bins)), numpy.zeros(bins)
    for (_, trough), (peak, _) in zip(slips, slips[1:]):
        inside = curve[(curve[:, 0] > trough) & (curve[:, 0] < peak) & numpy.isfinite(curve[:, 2])]
        if len(inside) < 6:
            continue
        phase = (inside[:, 0] - trough) / (peak - trough)
        line = numpy.polyval(numpy.polyfit(phase, inside[:, 1], 1), phase)
        place = numpy.clip((bins * phase).astype(int), 0, bins - 1)
        for i in (0, 1):
            numpy.add.at(sums[i], place, inside[:, 1 + i] - line)
        numpy.add.at(counts, place, 1.0)
    with numpy.errstate(invalid="ignore"):
        return (numpy.arange(bins) + 0.5) / bins, sums[0] / counts, sums[1] / counts


def misfit(stacked):
    if stacked is None:
        return None
    _, force, fitted, fall = stacked
    return float(numpy.sqrt(numpy.nanmean((force - fitted) ** 2)) / fall)


def estimate(parameter):
    if not parameter or parameter.get("value") is None:
        return "-"
    low, high = parameter.get("ci95") or (None, None)
    interval = f" [{low:.4g}, {high:.4g}]" if low is not None else ""
    return f"{parameter['value']:.4g}{interval} {parameter['status'][:4]}"


def terms_of(parameters):
    found = []
    for key, (symbol, scale, unit) in TERMS.items():
        value = (parameters.get(key) or {}).get("value")
        if value is not None:
            found.append(f"{symbol} {scale * value:.3g} {unit}")
    return ", ".join(found) or "none"


def table(manifest, builds):
    with open(manifest, newline="") as lines:
        rows = list(csv.DictReader(lines))
    for row in rows:
        slips = None
        print(row["id"])
        for build in builds:
            stated = [text for column, option in STATED.items() if row.get(column) for text in (option, row[column])]
            result = fit(build, row["file"], *stated)
            if result is None:
                print("    not read")
                continue
            document, curve, counted = result
            slips = slips or counted
            model = document.get("model") or {}
            parameters = document.get("parameters") or {}
            chi2 = (model.get("residual") or {}).get("reduced_chi2")
            left = misfit(stack(curve, slips)) if len(curve) else None
            quality = f"chi2 {chi2:.3g}" if chi2 is not None else "no fit"
            if left is not None:
                quality += f", stacked misfit {100.0 * left:.2g} %"
            print(f"    {document['status']}, {model.get('tier', '-')}, terms: {terms_of(parameters)}; {quality}")
            if parameters:
                print("      ", "; ".join(f"{symbol} {estimate(parameters.get(key))}" for key, symbol in SHOWN.items()))


def draw(out, slipfit, file, speed, groups):
    pyplot = use_matplotlib(10)
    figure, axes = pyplot.subplots(2, 2, sharex="col", figsize=(10, 5.5), height_ratios=(3, 2))
    slips = None
    for options, colour in zip(groups, ("#d55e00", "#0072b2", "#009e73")):
        document, curve, counted = fit(slipfit, file, "--speed", speed, *options)
        slips = slips or counted
        slip, stick = stack(curve, slips, -0.6, 1.6, 44), stack_sticks(curve, slips)
        fall = slip[3]
        name = f"{' '.join(options) or 'as found'}: {terms_of(document.get('parameters') or {})}"
        for (above, below), (phase, force, fitted) in zip(axes.T, (slip[:3], stick)):
            if colour == "#d55e00":
                above.plot(phase, force / fall, "k.", label="mean of the cycles")
            above.plot(phase, fitted / fall, color=colour, label=name)
            below.plot(phase, 100.0 * (force - fitted) / fall, color=colour)
    axes[0, 0].set_ylabel("force over its fall")
    axes[0, 1].set_ylabel("less the line through the stick")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="upper center", fontsize=8)
    for axis, phase in zip(axes[1], ("slip (0: peak, 1: trough)", "stick (0: trough, 1: next peak)")):
        axis.axhline(0.0, color="#777777", linewidth=0.5)
        axis.set_ylabel("left over, % of the fall")
        axis.set_xlabel("phase of the " + phase)
    figure.tight_layout(rect=(0.0, 0.0, 1.0, 0.88))
    save(figure, out)


def main():
    if len(sys.argv) > 3 and sys.argv[1] == "table":
        table(sys.argv[2], sys.argv[3:])
    elif len(sys.argv) > 5 and sys.argv[1] == "draw":
        groups, options = [[]], sys.argv[6:]
        for option in options:
            groups.append([]) if option == "--" else groups[-1].append(option)
        draw(*sys.argv[2:6], groups)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
