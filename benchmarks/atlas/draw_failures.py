#!/usr/bin/env python3
"""draw_failures.py FAILURES.csv[,MORE.csv] OUT [--compare]: failure maps of slipfit and other methods as SVG, one file a map in the folder OUT.

A cell is filled by how the method answers there: right, refused (it states that it has no answer), weak (it answers and
marks the answer as weak) or wrong (without a warning). Methods are drawn side by side. With --compare OUT is one file
that shows three maps of fits below each other. Tables are written by `atlas --only failures terms`. Needs matplotlib.
"""
import argparse
import csv
import math
import pathlib

import numpy

COLOURS = {"right": "#009e73", "refused": "#c8c8c8", "weak": "#f0e442", "wrong": "#d55e00"}
WORDS = {"right": "right", "refused": "refused: no answer", "weak": "answer marked as weak", "wrong": "wrong without a warning"}
NOISE, DROP = "noise / (F$_s$ − F$_k$)", " / (F$_s$ − F$_k$)"
MAPS = {  # name: (file, title, x, y)
    "forward": ("failures_forward", "Forward methods: constant friction", "stick-slip parameter λ", "damping ratio ζ"),
    "grazing": ("failures_grazing", "Forward methods near the limit of stick-slip", "distance from the limit |λ/λ$_c$ − 1|", "damping ratio ζ"),
    "speed": ("failures_speed", "Forward methods: friction that depends on speed (λ = 20, ζ = 0.05)", "|α| V λ", "|f$_1$|" + DROP),
    "frequency_noise": ("failures_frequency_noise", "Frequency: noise and few cycles", NOISE, "cycles"),
    "frequency_hum": ("failures_frequency_hum", "Frequency: hum and scatter of static friction", "50 Hz amplitude" + DROP, "scatter of F$_s$" + DROP),
    "fit_start": ("failures_fit_start", "Fits: starting values", "relative error of the starting values", "cycles"),
    "fit_sampling": ("failures_fit_sampling", "Fits: samples per slip and noise", "samples in a slip", NOISE),
    "fit_scatter": ("failures_fit_scatter", "Fits: scatter of static friction", "scatter of F$_s$" + DROP, "cycles"),
    "fit_hum": ("failures_fit_hum", "Fits: hum and noise", "50 Hz amplitude" + DROP, NOISE),
    "fit_average": ("failures_fit_average", "Fits: unstated averaging by the sensor", "averaging time × ω$_n$", NOISE),
    "fit_weakening": ("failures_fit_weakening", "Fits: friction that weakens over a slip distance", "k D$_c$" + DROP, NOISE)}
COMPARED = ("fit_scatter", "fit_hum", "fit_average")
COMPARED_METHODS = ("features: slopes, drops, falls", "whole trace, start off by 0.1 %", "cycles as blocks (slipfit fit)")
SHORT = {"features: slopes, drops, falls": "features of the slips", "whole trace, start off by 0.1 %": "whole trace, good start",
         "whole trace": "whole trace", "cycles as blocks (slipfit fit)": "slipfit fit",
         "three speeds jointly (slipfit fit --joint)": "slipfit fit --joint", "cycles as blocks, Coulomb friction alone": "slipfit, no further terms",
         "what slipfit fit quotes": "slipfit fit", "exact damped": "slipfit, damped tier", "velocity tier": "slipfit, velocity tier", "what slipfit analyze quotes": "slipfit analyze"}


def read(names):
    """{map: {method: [(x, y, answer)]}}, methods with slipfit's last."""
    maps = {}
    for name in names:
        for row in csv.DictReader(open(name, encoding="utf-8")):
            maps.setdefault(row["map"], {}).setdefault(row["method"], []).append((float(row["x"]), float(row["y"]), row["answer"]))
    return maps


def edges_of(values):
    """Edges of cells around values that are evenly spaced on a logarithmic axis."""
    step = math.sqrt(values[1] / values[0])
    return numpy.append(numpy.array(values) / step, values[-1] * step)


def limit_of_stick_slip(zeta):
    """lambda_c, docs/model.md (6)."""
    def excess(lam):
        b = math.sqrt(1.0 - zeta * zeta)
        return math.log(1.0 + lam * lam - 2.0 * zeta * lam) - 2.0 * zeta / b * (2.0 * math.pi - math.atan2(b * lam, 1.0 - zeta * lam))
    low, high = 2.0 * zeta, 1e6
    for _ in range(200):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if excess(middle) < 0.0 else (low, middle)
    return high


def fill(axes, cells, name):
    """Neighbouring cells of one answer are one rectangle."""
    xs, ys = sorted({x for x, _, _ in cells}), sorted({y for _, y, _ in cells})
    answers = {(x, y): answer for x, y, answer in cells}
    x_edges, y_edges = edges_of(xs), edges_of(ys)
    for line, y in enumerate(ys):
        start = 0
        for end in range(1, len(xs) + 1):
            kind = answers[xs[start], y]
            if end < len(xs) and answers[xs[end], y] == kind:
                continue
            corners = [x_edges[start], x_edges[end], x_edges[end], x_edges[start]], [y_edges[line]] * 2 + [y_edges[line + 1]] * 2
            axes.fill(*corners, facecolor=COLOURS[kind], edgecolor=COLOURS[kind], linewidth=0.4)
            start = end
    axes.set(xscale="log", yscale="log", xlim=x_edges[[0, -1]], ylim=y_edges[[0, -1]])
    if name == "forward":
        zetas = numpy.geomspace(ys[0], ys[-1], 50)
        axes.plot([limit_of_stick_slip(z) for z in zetas], zetas, color="black", linewidth=1.2)


def add_legend(figure, height, remark):
    from matplotlib.patches import Patch
    patches = [Patch(facecolor=colour, label=WORDS[kind]) for kind, colour in COLOURS.items()]
    figure.legend(handles=patches, loc="lower center", ncol=4, frameon=False, fontsize=9, bbox_to_anchor=(0.5, 0.26 / height))
    figure.text(0.5, 0.12 / height, remark, ha="center", fontsize=8, color="#444444")


REMARK = "Methods other than slipfit are our own implementations."


def draw_map(name, methods, out):
    from matplotlib import pyplot
    file, title, x, y = MAPS[name]
    across = min(4, len(methods))
    down = -(-len(methods) // across)
    height = 2.15 * down + 1.1
    figure, axes = pyplot.subplots(down, across, figsize=(max(5.6, 2.35 * across + 0.4), height), sharex=True, sharey=True, squeeze=False)
    for place, axis in enumerate(axes.flat):
        axis.set_visible(place < len(methods))
    for place, (method, cells) in enumerate(methods.items()):
        axis = axes.flat[place]
        fill(axis, cells, name)
        axis.set_title(SHORT.get(method, method), fontsize=8)
        if place % across == 0:
            axis.set_ylabel(y)
        if place + across >= len(methods):
            axis.set_xlabel(x, fontsize=8)
            axis.tick_params(labelbottom=True)
    figure.suptitle(title, fontsize=10.5, fontweight="bold")
    add_legend(figure, height, REMARK)
    figure.tight_layout(rect=(0.0, 0.5 / height, 1.0, 1.0))
    figure.savefig(out / f"{file}.svg", metadata={"Date": None})
    pyplot.close(figure)


def draw_comparison(maps, out):
    from matplotlib import pyplot
    height = 2.2 * len(COMPARED) + 0.7
    figure, axes = pyplot.subplots(len(COMPARED), len(COMPARED_METHODS), figsize=(8.4, height), squeeze=False)
    for line, name in enumerate(COMPARED):
        for column, method in enumerate(COMPARED_METHODS):
            axis = axes[line][column]
            fill(axis, maps[name][method], name)
            axis.set_xlabel(MAPS[name][2])
            if column == 0:
                axis.set_ylabel(MAPS[name][3])
            if line == 0:
                axis.set_title(SHORT[method], fontsize=10, fontweight="bold")
    add_legend(figure, height, REMARK)
    figure.tight_layout(rect=(0.0, 0.5 / height, 1.0, 1.0))
    figure.savefig(out, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", help="separated by commas")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--compare", action="store_true", help="three maps in one file")
    arguments = parser.parse_args()
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "slipfit", "svg.fonttype": "none", "font.size": 8.5})
    maps = read(arguments.tables.split(","))
    if arguments.compare:
        return draw_comparison(maps, arguments.out)
    for name, methods in maps.items():
        draw_map(name, methods, arguments.out)


if __name__ == "__main__":
    main()
