#!/usr/bin/env python3
"""plot_sweep.py SWEEP.json PREDICTION.json [--also OTHER.json] [--title TEXT] --out PICTURE.svg

Draws what a joint fit predicts against what was measured: spacing over driving speed from `slipfit predict SWEEP.json
--speeds A:B:N --json --out PREDICTION.json` with its 95 % band, the spacing of each recording of the sweep, what the
others predict for it, and where stick-slip ends. --also draws the recordings of a further sweep that the fit has not
seen. The picture's format follows from its ending.
"""

import argparse
import json
import sys

try:
    import matplotlib
except ImportError:
    sys.exit("plot_sweep.py: needs matplotlib (Debian: python3-matplotlib)")

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MODEL, MEASURED, LEFT_OUT, END = "#0072b2", "#222222", "#d55e00", "#999999"


def read(file):
    with open(file, encoding="utf-8") as stream:
        return json.load(stream)


def bars(points):
    """x, y and the two lengths of the error bars, for points of (speed, {value, ci95})."""
    speeds = [speed * 1e3 for speed, _ in points]
    values = [spacing["value"] * 1e3 for _, spacing in points]
    ends = [spacing["ci95"] or [spacing["value"]] * 2 for _, spacing in points]
    low = [max(0.0, value - end[0] * 1e3) for value, end in zip(values, ends)]
    high = [max(0.0, end[1] * 1e3 - value) for value, end in zip(values, ends)]
    return speeds, values, [low, high]


def measured(document, statuses):
    return [
        (r["recording"]["speed_m_per_s"], r["derived"]["pattern_spacing_m"])
        for r in document["recordings"]
        if r["status"] in statuses and r["derived"]["pattern_spacing_m"]["value"] is not None
    ]


def draw_recordings(axes, document, label, fill):
    kinds = ((["stick_slip"], "o", label), (["undetermined", "oscillatory_slip"], "s", "measured, verdict open"))
    for statuses, marker, words in kinds:
        points = measured(document, statuses)
        if not points:
            continue
        x, y, reach = bars(points)
        face = MEASURED if fill else "white"
        axes.errorbar(x, y, reach, fmt=marker, color=MEASURED, markerfacecolor="white" if marker == "s" else face, markersize=5, linewidth=1, label=words)
    steady = [r["recording"]["speed_m_per_s"] * 1e3 for r in document["recordings"] if r["status"] == "steady_sliding"]
    if steady:
        axes.plot(steady, [0.03] * len(steady), "|", color=MEASURED, markersize=12, label="steady sliding",
                  transform=axes.get_xaxis_transform())


def draw_prediction(axes, prediction):
    rows = [r for r in prediction["rows"] if r["periodic_displacement_m"]["value"] is not None]
    speeds = [r["speed_m_per_s"] * 1e3 for r in rows]
    values = [r["periodic_displacement_m"]["value"] * 1e3 for r in rows]
    axes.plot(speeds, values, color=MODEL, linewidth=1.5, label="joint fit")
    banded = [r for r in rows if r["periodic_displacement_m"]["ci95"]]
    low, high = ([r["periodic_displacement_m"]["ci95"][end] * 1e3 for r in banded] for end in (0, 1))
    axes.fill_between([r["speed_m_per_s"] * 1e3 for r in banded], low, high, color=MODEL, alpha=0.15, linewidth=0,
                      label="its 95 % band")
    critical = prediction["critical_speed_m_per_s"]
    if critical["ci95"]:
        axes.axvspan(*(end * 1e3 for end in critical["ci95"]), color=END, alpha=0.2, linewidth=0,
                     label="stick-slip ends (95 %)")
    if critical["value"]:
        axes.axvline(critical["value"] * 1e3, color=END, linewidth=1, linestyle="--")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sweep")
    parser.add_argument("prediction")
    parser.add_argument("--also")
    parser.add_argument("--title")
    parser.add_argument("--out", required=True)
    options = parser.parse_args()
    sweep = read(options.sweep)
    figure, axes = plt.subplots(figsize=(7.5, 4.6), layout="constrained")
    draw_prediction(axes, read(options.prediction))
    draw_recordings(axes, sweep, "measured, fitted", fill=True)
    if options.also:
        draw_recordings(axes, read(options.also), "measured, not seen by the fit", fill=False)
    left_out = [
        (r["recording"]["speed_m_per_s"] * 1.03, r["joint"]["spacing_left_out_m"])
        for r in sweep["recordings"]
        if r.get("joint") and r["joint"]["spacing_left_out_m"]["value"] is not None
    ]
    if left_out:
        x, y, reach = bars(left_out)
        axes.errorbar(x, y, reach, fmt="D", color=LEFT_OUT, markersize=4, linewidth=1,
                      label="predicted without that recording")
    axes.set(xscale="log", xlabel="driving speed [mm/s]", ylabel="spacing [mm]")
    axes.set_ylim(bottom=0.0)
    if options.title:
        axes.set_title(options.title, fontsize=10)
    handles, labels = axes.get_legend_handles_labels()
    once = dict(zip(labels, handles))
    axes.legend(once.values(), once.keys(), fontsize=8, frameon=False, loc="lower left")
    figure.savefig(options.out)


if __name__ == "__main__":
    main()
