#!/usr/bin/env python3
"""plot_fit.py CURVE.csv [--cycles CYCLES.csv] [--zoom 4] [--title TEXT] --out PICTURE.svg

Draws what `slipfit fit REC --speed V --curve CURVE.csv --cycles CYCLES.csv` wrote: the trace with the fit on it, the
residual, and a few cycles close up with their onsets and ends of slip. The picture's format follows from its ending.
"""

import argparse
import csv
import sys

try:
    import matplotlib
except ImportError:
    sys.exit("plot_fit.py: needs matplotlib (Debian: python3-matplotlib)")

matplotlib.use("Agg")
import matplotlib.pyplot as plt

TRACE, FIT, RESIDUAL, EVENT = "#8a8f98", "#c0392b", "#2c6fad", "#1e8449"


def read_table(file):
    """Columns by name; an empty cell is nan."""
    with open(file, newline="", encoding="utf-8") as stream:
        rows = list(csv.reader(stream))
    if len(rows) < 2:
        sys.exit(f"plot_fit.py: {file}: no rows")
    cells = ([float(cell) if cell else float("nan") for cell in row] for row in rows[1:])
    return dict(zip(rows[0], map(list, zip(*cells))))


def force_column(table, stem):
    """The column stem_N or stem_coefficient, and the axis label that goes with it."""
    if f"{stem}_N" in table:
        return table[f"{stem}_N"], "force [N]"
    return table[f"{stem}_coefficient"], "friction coefficient"


def zoom_range(cycles, time_s, count):
    """From before a slip in the middle of the recording over `count` cycles."""
    peaks = cycles["peak_s"] if cycles else []
    if len(peaks) < 2:
        return time_s[0], time_s[-1]
    first = max(0, len(peaks) // 2 - count // 2)
    last = min(first + count, len(peaks) - 1)
    margin = 0.3 * (peaks[last] - peaks[first]) / max(1, last - first)
    return peaks[first] - margin, peaks[last] + margin


def draw_events(axes, cycles, begin_s, end_s):
    for key, style in (("onset_s", ":"), ("end_s", "--")):
        inside = [t for t in cycles[key] if begin_s <= t <= end_s]
        for number, time_s in enumerate(inside):
            label = {"onset_s": "onset of slip", "end_s": "end of slip"}[key] if number == 0 else None
            axes.axvline(time_s, color=EVENT, linestyle=style, linewidth=0.8, label=label)


def legend_above(axes):
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncol=4, fontsize=8, frameon=False)


def draw(curve, cycles, zoom, title):
    time_s = curve["time_s"]
    force, label = force_column(curve, "force")
    fitted, _ = force_column(curve, "fitted")
    residual, _ = force_column(curve, "residual")
    figure, (whole, rest, close) = plt.subplots(
        3, 1, figsize=(9, 7.5), gridspec_kw={"height_ratios": [2, 1, 2.4]}, constrained_layout=True
    )
    begin_s, end_s = zoom_range(cycles, time_s, zoom)
    whole.plot(time_s, force, color=TRACE, linewidth=0.7, label="recording", rasterized=True)
    whole.plot(time_s, fitted, color=FIT, linewidth=0.7, label="fit", rasterized=True)
    whole.axvspan(begin_s, end_s, color="#f4d03f", alpha=0.25, linewidth=0, label="close up below")
    whole.set(ylabel=label)
    whole.set_title(title, loc="left")
    legend_above(whole)
    rest.plot(time_s, residual, color=RESIDUAL, linewidth=0.5, rasterized=True)
    rest.axhline(0.0, color="black", linewidth=0.5)
    rest.set(ylabel="residual [N]" if label.endswith("[N]") else "residual")
    rest.sharex(whole)
    inside = [i for i, t in enumerate(time_s) if begin_s <= t <= end_s]
    close.plot([time_s[i] for i in inside], [force[i] for i in inside], ".", color=TRACE, markersize=4, label="recording")
    close.plot([time_s[i] for i in inside], [fitted[i] for i in inside], color=FIT, linewidth=1.2, label="fit")
    if cycles:
        draw_events(close, cycles, begin_s, end_s)
    close.set(ylabel=label, xlabel="time [s]", xlim=(begin_s, end_s))
    legend_above(close)
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("curve")
    parser.add_argument("--cycles")
    parser.add_argument("--zoom", type=int, default=4, help="cycles close up")
    parser.add_argument("--title", default="")
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    cycles = read_table(arguments.cycles) if arguments.cycles else None
    matplotlib.rcParams["svg.hashsalt"] = "slipfit"  # the same data, the same bytes
    figure = draw(read_table(arguments.curve), cycles, arguments.zoom, arguments.title)
    metadata = {"Date": None} if arguments.out.endswith(".svg") else None
    figure.savefig(arguments.out, dpi=80, metadata=metadata)


main()
