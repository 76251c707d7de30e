#!/usr/bin/env python3
"""Draws the tables of the studies as SVG by matplotlib; the same table gives the same bytes.

draw.py failures TABLE,... FOLDER       failure maps of `atlas --only failures terms`, one file a map
draw.py compared TABLE,... FILE         three maps of fits in one file
draw.py front TABLE,... FILE [--quantities k,alpha] [--scenes A,B] [--coverage]    accuracy against CPU time, measured by peers/front.py
draw.py atlas FOLDER FOLDER             the tables that `atlas --only forward frequency fits` writes in the first folder
draw.py coverage SUMMARY,... FILE       coverage of the 95 % intervals as coverage/summarise.py prints it, one row a family

A cell of a failure map is filled by how the method answers there: right, refused (it states that it has no answer), weak (it answers and marks
the answer as weak) or wrong (without a warning). Bars of the coverage contain 95 % of the chance that the number of recordings leaves (Wilson).
"""
import collections
import csv
import math
import pathlib

import numpy

from study import parser

NOISE, DROP = "noise / (F$_s$ − F$_k$)", " / (F$_s$ − F$_k$)"
BLACK, GREY, SKY, BLUE, GREEN, YELLOW, ORANGE, RED, PURPLE = ("#000000", "#777777", "#56b4e9", "#0072b2", "#009e73", "#f0e442", "#e69f00", "#d55e00",
                                                              "#cc79a7")


def use_matplotlib(font_size):
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "slipfit", "svg.fonttype": "none", "font.size": font_size})
    from matplotlib import pyplot
    return pyplot


def save(figure, file):
    from matplotlib import pyplot
    figure.savefig(file, metadata={"Date": None})
    pyplot.close(figure)


def read_tables(names):
    return [row for name in names.split(",") for row in csv.DictReader(open(name, encoding="utf-8"))]


def staircase(points):
    """The Pareto front: no point has less error for less time."""
    front = []
    for x, y in sorted(points):
        if not front or y < front[-1][1]:
            front += [(x, front[-1][1]), (x, y)] if front else [(x, y)]
    return front


def draw_points(file, x, y, points):
    """A mark with its name for each method; both axes are logarithmic."""
    pyplot = use_matplotlib(9)
    figure, axis = pyplot.subplots(figsize=(8.0, 4.0))
    for (name, (at_x, at_y)), colour in zip(points.items(), (BLACK, ORANGE, RED, BLUE)):
        axis.plot([at_x], [at_y], "o", color=colour, label=name, markersize=7)
    axis.set(xlabel=x, ylabel=y, xscale="log", yscale="log")
    axis.margins(0.2)
    axis.grid(True, which="both", color="#e4e4e4", linewidth=0.6)
    axis.legend(fontsize=8, loc="center")
    figure.tight_layout()
    save(figure, file)


# -- failure maps

COLOURS = {"right": GREEN, "refused": "#c8c8c8", "weak": YELLOW, "wrong": RED}
WORDS = {"right": "right", "refused": "refused: no answer", "weak": "answer marked as weak", "wrong": "wrong without a warning"}
MAPS = {  # name: (title, x, y)
    "forward": ("Forward methods: constant friction", "stick-slip parameter λ", "damping ratio ζ"),
    "grazing": ("Forward methods near the limit of stick-slip", "distance from the limit |λ/λ$_c$ − 1|", "damping ratio ζ"),
    "speed": ("Forward methods: friction that depends on speed (λ = 20, ζ = 0.05)", "|α| V λ", "|f$_1$|" + DROP),
    "frequency_noise": ("Frequency: noise and few cycles", NOISE, "cycles"),
    "frequency_hum": ("Frequency: hum and scatter of static friction", "50 Hz amplitude" + DROP, "scatter of F$_s$" + DROP),
    "fit_start": ("Fits: starting values", "relative error of the starting values", "cycles"),
    "fit_sampling": ("Fits: samples per slip and noise", "samples in a slip", NOISE),
    "fit_scatter": ("Fits: scatter of static friction", "scatter of F$_s$" + DROP, "cycles"),
    "fit_hum": ("Fits: hum and noise", "50 Hz amplitude" + DROP, NOISE),
    "fit_average": ("Fits: unstated averaging by the sensor", "averaging time × ω$_n$", NOISE),
    "fit_weakening": ("Fits: friction that weakens over a slip distance", "k D$_c$" + DROP, NOISE)}
COMPARED = ("fit_scatter", "fit_hum", "fit_average")
COMPARED_METHODS = ("features: slopes, drops, falls", "whole trace, start off by 0.1 %", "cycles as blocks (slipfit fit)")
SHORT = {"features: slopes, drops, falls": "features of the slips", "whole trace, start off by 0.1 %": "whole trace, good start",
         "whole trace": "whole trace", "cycles as blocks (slipfit fit)": "slipfit fit",
         "three speeds jointly (slipfit fit --joint)": "slipfit fit --joint", "cycles as blocks, Coulomb friction alone": "slipfit, no further terms",
         "what slipfit fit quotes": "slipfit fit", "exact damped": "slipfit, damped tier", "velocity tier": "slipfit, velocity tier",
         "what slipfit analyze quotes": "slipfit analyze"}


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


def finish_map(figure, height, file):
    from matplotlib.patches import Patch
    patches = [Patch(facecolor=colour, label=WORDS[kind]) for kind, colour in COLOURS.items()]
    figure.legend(handles=patches, loc="lower center", ncol=4, frameon=False, fontsize=9, bbox_to_anchor=(0.5, 0.26 / height))
    figure.text(0.5, 0.12 / height, "Methods other than slipfit are our own implementations.", ha="center", fontsize=8, color="#444444")
    figure.tight_layout(rect=(0.0, 0.5 / height, 1.0, 1.0))
    save(figure, file)


def read_maps(names):
    """{map: {method: [(x, y, answer)]}}, methods with slipfit's last."""
    maps = {}
    for row in read_tables(names):
        maps.setdefault(row["map"], {}).setdefault(row["method"], []).append((float(row["x"]), float(row["y"]), row["answer"]))
    return maps


def draw_failures(given):
    pyplot = use_matplotlib(8.5)
    for name, methods in read_maps(given.tables).items():
        title, x, y = MAPS[name]
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
        finish_map(figure, height, given.out / f"failures_{name}.svg")


def draw_compared(given):
    pyplot, maps = use_matplotlib(8.5), read_maps(given.tables)
    height = 2.2 * len(COMPARED) + 0.7
    figure, axes = pyplot.subplots(len(COMPARED), len(COMPARED_METHODS), figsize=(8.4, height), squeeze=False)
    for line, name in enumerate(COMPARED):
        for column, method in enumerate(COMPARED_METHODS):
            axis = axes[line][column]
            fill(axis, maps[name][method], name)
            axis.set_xlabel(MAPS[name][1])
            if column == 0:
                axis.set_ylabel(MAPS[name][2])
            if line == 0:
                axis.set_title(SHORT[method], fontsize=10, fontweight="bold")
    finish_map(figure, height, given.out)


# -- accuracy against CPU time

SCENES = {"plain": "no deviation from the model", "scatter30": "static friction scatters by 30 %", "noisy": "noise",
          "mains_drifting": "hum and drift", "boxcar": "the sensor averages", "weakening": "friction weakens over a distance",
          "reload": "force rises after a slip", "ageing": "static friction ages", "exponential_strong": "sweeps of five speeds"}
QUANTITIES = {"k": "stiffness k", "spacing": "spacing V/f", "w_n": "natural frequency ω$_n$", "zeta": "damping ratio ζ", "alpha": "velocity dependence α"}
DEFAULT = "slipfit fit"
METHODS = {  # name: (colour, marker)
    DEFAULT: (BLACK, "o"), "slipfit, a third of the cycles": (BLUE, "v"), "slipfit, every fourth sample": (SKY, "s"),
    "slipfit --tier damped": (GREEN, "D"), "features of the slips": (GREY, "x"), "scipy, whole trace": (RED, "^"),
    "scipy, cycles as blocks": (ORANGE, "P")}


def numbers_of(row, y):
    return float(row["median_cpu_ms"]), float(row[y])


def mark(axes, row, y):
    colour, marker = METHODS[row["method"]]
    is_default = row["method"] == DEFAULT
    x, y = numbers_of(row, y)
    axes.plot([x], [y], marker, color=colour, markersize=9 if is_default else 6.5, linestyle="none", zorder=4 if is_default else 3)


def draw_error(axes, rows):
    known = [r for r in rows if r["median_error"]]
    front = staircase([numbers_of(r, "median_error") for r in known])
    if front:
        axes.plot([x for x, _ in front] + [axes.get_xlim()[1]], [y for _, y in front] + [front[-1][1]], "--", color="#999999",
                  linewidth=1.2, zorder=1)
    for row in known:
        mark(axes, row, "median_error")


def name_coverage(axes, rows):
    """The coverage of the default and of other methods as text next to their marks."""
    for row in rows:
        if not row["covered"] or not row["median_error"] or (row["method"].startswith("slipfit") and row["method"] != DEFAULT):
            continue
        at = {DEFAULT: (-4, -14), "scipy, whole trace": (-20, 8)}.get(row["method"], (-2, 8))
        axes.annotate(f"{100.0 * float(row['covered']):.0f} %", numbers_of(row, "median_error"),
                      textcoords="offset points", xytext=at, fontsize=8, color=METHODS[row["method"]][0])


def draw_coverage_of(axes, rows):
    axes.axhline(0.95, color="#999999", linewidth=1.0, zorder=1)
    for row in rows:
        if row["covered"]:
            mark(axes, row, "covered")


def set_axes(axes, is_error, limits):
    from matplotlib.ticker import FixedLocator, LogLocator, NullFormatter
    axes.set(xscale="log", xlim=limits[0])
    axes.xaxis.set_major_locator(FixedLocator([10.0**power for power in range(-1, 5)]))
    axes.xaxis.set_minor_formatter(NullFormatter())
    if is_error:
        axes.set(yscale="log", ylim=limits[1])
        axes.yaxis.set_major_locator(LogLocator(numticks=8))
        axes.yaxis.set_minor_formatter(NullFormatter())
    else:
        axes.set(ylim=(-0.05, 1.08))
    axes.grid(True, color="#e4e4e4", linewidth=0.6)


def limits_of(rows):
    """Axes that end outside the data, with room for the coverage."""
    times, errors = zip(*(numbers_of(r, "median_error") for r in rows if r["median_error"]))
    return (min(times) / 3.0, max(times) * 4.0), (min(errors) / 8.0, max(errors) * 8.0)


def placed(panels, quantities, across):
    """With several quantities: a column for each quantity, a row for each scene that has the first one."""
    if len(quantities) == 1:
        return panels
    scenes = [s for s, q, _ in panels if q == quantities[0]]
    places = {scenes.index(s) * across + quantities.index(q) if s in scenes else quantities.index(q): (s, q, mine) for s, q, mine in panels}
    return [places.get(i) for i in range(max(places) + 1)]


def draw_front(given):
    """Rows of panels: a scene (with the coverage as text, or in panels of its own) over the quantities."""
    pyplot, rows, quantities = use_matplotlib(9), read_tables(given.tables), given.quantities.split(",")
    scenes = given.scenes.split(",") if given.scenes else [s for s in SCENES if any(r["scene"] == s for r in rows)]
    panels = [(s, q, [r for r in rows if r["scene"] == s and r["quantity"] == q]) for s in scenes for q in quantities]
    panels = [panel for panel in panels if any(r["median_error"] for r in panel[2])]
    limits = limits_of([row for panel in panels for row in panel[2]])
    across = min(4, len(panels)) if len(quantities) == 1 else len(quantities)
    panels = placed(panels, quantities, across)
    kinds = 2 if given.coverage else 1
    down = kinds * -(-len(panels) // across)
    height = 2.5 * down + 0.7
    figure, axes = pyplot.subplots(down, across, figsize=(8.9, height), sharex=True, sharey="row", squeeze=False)
    for index, one in enumerate(panels + [None] * (-len(panels) % across)):
        column, line = index % across, kinds * (index // across)
        if one is None:
            axes[line][column].set_visible(False)
            continue
        scene, quantity, mine = one
        panel = axes[line][column]
        set_axes(panel, True, limits)
        draw_error(panel, mine)
        title = SCENES[scene] if len(quantities) == 1 else f"{QUANTITIES[quantity]}\n{SCENES[scene]}"
        panel.set_title(title, fontsize=9.5 if across < 4 else 8)
        if column == 0:
            panel.set_ylabel("median relative error")
        if kinds == 1:
            name_coverage(panel, mine)
            continue
        panel = axes[line + 1][column]
        set_axes(panel, False, limits)
        draw_coverage_of(panel, mine)
        if column == 0:
            panel.set_ylabel("coverage of the\n95 % intervals")
    for line, column in numpy.ndindex(axes.shape):
        if line + 1 == down or not axes[line + 1][column].get_visible():
            axes[line][column].set_xlabel("CPU time [ms]")
            axes[line][column].tick_params(labelbottom=True)
    used = {row["method"] for panel in panels if panel for row in panel[2] if row["median_error"]}
    marks = [pyplot.Line2D([], [], color=c, marker=m, linestyle="none", label=name) for name, (c, m) in METHODS.items() if name in used]
    marks.append(pyplot.Line2D([], [], color="#999999", linestyle="--",
                               label="Pareto front" if kinds == 2 else "Pareto front;  %: coverage of the intervals"))
    figure.legend(handles=marks, loc="lower center", ncol=4, fontsize=8, frameon=False, columnspacing=1.2, handletextpad=0.4)
    figure.tight_layout(rect=(0.0, 0.55 / height, 1.0, 1.0))
    save(figure, given.out)


# -- coverage

PARAMETERS = ["k", "dF", "w_n", "zeta", "spacing"]


def read_coverage(names):
    """{family: {parameter: (given, share inside)}} from the lines of the summaries."""
    rows = collections.defaultdict(dict)
    for line in (line for name in names.split(",") for line in pathlib.Path(name).read_text(encoding="utf-8").splitlines()):
        parts = line.replace("!", " ").split()
        place = next((i for i, part in enumerate(parts) if part in PARAMETERS), 0)
        if 0 < place < 3 and len(parts) >= place + 4:
            rows[" ".join(parts[:place])][parts[place]] = (float(parts[place + 2]), 0.01 * float(parts[place + 3]))
    return rows


def wilson(count, share):
    z = 1.96
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z / (1 + z * z / count) * math.sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    return middle - half, middle + half


def draw_coverage(given):
    pyplot, rows = use_matplotlib(9), read_coverage(given.tables)
    figure, axes = pyplot.subplots(1, len(PARAMETERS), figsize=(10.0, 0.25 * len(rows) + 1.0), sharey=True)
    for axis, parameter in zip(axes, PARAMETERS):
        axis.set(title=parameter, xlim=(80, 100), ylim=(len(rows) - 0.5, -0.5), yticks=range(len(rows)), yticklabels=rows)
        axis.axvline(95, color=RED, linewidth=1.0)
        known = [(y, *parameters[parameter]) for y, parameters in enumerate(rows.values()) if parameter in parameters]
        axis.hlines([y for y, *_ in known], *([100 * wilson(*of)[end] for _, *of in known] for end in (0, 1)), color="#224477", linewidth=2)
        axis.plot([100 * share for *_, share in known], [y for y, *_ in known], "o", color="#224477", markersize=4)
        axis.grid(True, axis="x", color="#e4e4e4", linewidth=0.6)
    figure.supxlabel("truth inside the 95 % interval, % of the recordings", fontsize=9)
    figure.tight_layout()
    save(figure, given.out)


# -- the atlas

LOOKS = {  # method: (colour, marker, line)
    "sawtooth limit": (GREY, "o", "-"), "undamped closed form": (SKY, "o", "-"), "paper's approximation": (PURPLE, "o", "-"), "exact damped": (BLACK, "o", "-"),
    "velocity tier": (BLUE, "o", "-"), "RK4, sign switching": (ORANGE, "$◯$", "-"), "time stepping (Moreau)": (PURPLE, "x", "-."),
    "ODE 5(4), event location": (GREEN, "^", "-"), "switch model (Leine)": (SKY, "^", "--"), "tanh-smoothed": (RED, "$◯$", ":"),
    "FFT peak": (GREY, "x", "-"), "FFT peak, interpolated": (SKY, "$◯$", "--"), "FFT peak, 16 x zero-padded": (PURPLE, "^", ":"),
    "autocorrelation peak": (ORANGE, "$◯$", "-"), "slip counting (slipfit)": (GREEN, "^", "-"), "harmonic least squares (slipfit)": (BLUE, "o", "-."),
    "what slipfit analyze quotes": (RED, "$◯$", "-"), "what slipfit fit quotes": (BLACK, "o", "-"),
    "features: slopes, drops, falls": (GREY, "x", "-"), "whole trace, start off by 0.1 %": (SKY, "^", "--"), "whole trace, start off by 1 %": (PURPLE, "^", ":"),
    "whole trace, start off by 10 %": (ORANGE, "^", "-."), "cycles as blocks (slipfit fit)": (BLACK, "o", "-"),
    "three speeds jointly (slipfit fit --joint)": (BLUE, "$◯$", "-"), "bound": (BLACK, "", "--"), "Pareto front": ("#999999", "", "--")}
FACTORS = {"noise": "noise, rms" + DROP, "jitter": "scatter of F$_s$" + DROP, "drift": "drift over the recording" + DROP, "hum": "50 Hz amplitude" + DROP,
           "cycles": "cycles", "samples": "samples in a slip"}
PERIOD, WAVE = "relative error of the period", "rms error of the waveform / its rms"
USUAL = "usually 40 cycles, 20 samples per slip, noise of 0.02 of the drop"


def series_of(rows, x, y):
    """{method: [(x, y)]} of the rows that have both."""
    series = collections.defaultdict(list)
    for row in rows:
        if row[x] and row[y]:
            series[row["method"]].append((float(row[x]), float(row[y])))
    return series


def draw_panels(file, title, panels):
    """`panels`: (x label, y label, {method: points}); values of a share are on a linear axis."""
    pyplot = use_matplotlib(9)
    figure, axes = pyplot.subplots(len(panels), 1, figsize=(8.0, 3.2 * len(panels) + 1.4), squeeze=False)
    for axis, (x, y, series) in zip(axes[:, 0], panels):
        for method, points in series.items():
            colour, marker, line = LOOKS[method]
            axis.plot(*zip(*points), marker=marker, linestyle=line, color=colour, label=method, markersize=5, linewidth=1.2)
        axis.set(xlabel=x, ylabel=y, xscale="log", yscale="linear" if y.startswith(("share", "coverage")) else "log")
        axis.grid(True, color="#e4e4e4", linewidth=0.6)
    labels = {label: handle for axis in axes[:, 0] for handle, label in zip(*axis.get_legend_handles_labels())}
    height = figure.get_size_inches()[1]
    figure.legend(labels.values(), labels, loc="lower center", ncol=3, fontsize=8, frameon=False)
    figure.suptitle(title, fontsize=10.5, fontweight="bold")
    figure.tight_layout(rect=(0.0, 0.9 / height, 1.0, 1.0))
    save(figure, file)


def with_front(series, usual=None):
    points = usual or [point for mine in series.values() for point in mine]
    front = staircase(points)
    return {"Pareto front": [*front, (max(x for x, _ in points), front[-1][1])], **series} if points else series


def draw_forward(folder, out):
    rows = read_tables(str(folder / "forward.csv"))
    for friction, name, words in (("constant", "constant", "constant friction"), ("of_speed", "speed", "friction that depends on the speed")):
        mine = [row for row in rows if row["friction"] == friction]
        draw_panels(out / f"forward_{name}.svg", f"Forward methods, {words}: medians over a grid of λ and ζ",
                    [("CPU time for one cycle with 200 samples [µs]", label, with_front(series_of(mine, "median_cpu_us", column)))
                     for column, label in (("median_period_error", PERIOD), ("median_waveform_error", WAVE))])
    series = series_of(read_tables(str(folder / "forward_lambda.csv")), "lambda", "period_error")
    draw_panels(out / "forward_lambda.svg", "Forward methods over λ, constant friction, ζ = 0.05", [("stick-slip parameter λ", PERIOD, series)])


def draw_frequency(folder, out):
    rows = read_tables(str(folder / "frequency.csv"))
    times = [row for row in rows if row["factor"] == "time"]
    usual = [point for points in series_of([r for r in times if float(r["value"]) == 0.02], "median_cpu_us", "relative_error").values() for point in points]
    draw_panels(out / "frequency_time.svg", "Frequency: error against time; noise of 0.2 (top), 0.02 (the front) and 0.002 of the drop",
                [("CPU time for one recording of 40 cycles [µs]", "relative error of the frequency",
                  with_front(series_of(times, "median_cpu_us", "relative_error"), usual))])
    panels = []
    for factor in dict.fromkeys(row["factor"] for row in rows if row["factor"] != "time"):
        mine = [row for row in rows if row["factor"] == factor]
        bound = sorted({(float(row["value"]), float(row["bound"])) for row in mine})
        panels.append((FACTORS[factor], "relative error of the frequency", {"bound": bound, **series_of(mine, "value", "relative_error")}))
    draw_panels(out / "frequency_factors.svg", f"Frequency: size of 68 % of the errors,\n{USUAL}", panels)


def draw_fits(folder, out):
    rows = read_tables(str(folder / "fit.csv"))
    times, panels = [row for row in rows if row["factor"] == "time"], []
    for parameter in ("w_n", "F_s-F_k", "k"):
        mine = [row for row in times if row["parameter"] == parameter]
        usual = [p for points in series_of([r for r in mine if float(r["value"]) == 40], "median_cpu_ms", "error_over_bound").values() for p in points]
        panels.append(("CPU time of the fit [ms]", f"error of {parameter} over the bound", with_front(series_of(mine, "median_cpu_ms", "error_over_bound"), usual)))
    draw_panels(out / "fit_time.svg", "Fits: error over the bound against time; 10, 40 (the front) and 160 cycles", panels)
    errors, coverage, wrong = [], [], []
    for factor in dict.fromkeys(row["factor"] for row in rows if row["factor"] != "time"):
        mine = [row for row in rows if row["factor"] == factor]
        of_omega = [row for row in mine if row["parameter"] == "w_n"]
        bound = sorted({float(r["value"]): float(r["relative_error"]) / float(r["error_over_bound"]) for r in of_omega if r["relative_error"]}.items())
        largest = collections.defaultdict(dict)
        for row in mine:
            worst = largest[row["method"]]
            worst[float(row["value"])] = max(worst.get(float(row["value"]), 0.0), float(row["share_confidently_wrong"]))
        errors.append((FACTORS[factor], "relative error of ω$_n$", {"bound": bound, **series_of(of_omega, "value", "relative_error")}))
        coverage.append((FACTORS[factor], "coverage of the intervals of ω$_n$", series_of(of_omega, "value", "coverage")))
        wrong.append((FACTORS[factor], "share of confidently wrong fits", {method: list(shares.items()) for method, shares in largest.items()}))
    draw_panels(out / "fit_factors.svg", f"Fits: size of 68 % of the errors of ω$_n$,\n{USUAL}", errors)
    draw_panels(out / "fit_coverage.svg", f"Fits: coverage of the 95 % intervals of ω$_n$,\n{USUAL}", coverage)
    draw_panels(out / "fit_wrong.svg", "Fits that are called identified and are off by more than\n4 standard errors and 2 %, for the worst parameter", wrong)


def draw_atlas(given):
    for name, draw in (("forward", draw_forward), ("frequency", draw_frequency), ("fit", draw_fits)):
        if (pathlib.Path(given.tables) / f"{name}.csv").exists():
            draw(pathlib.Path(given.tables), given.out)


def main():
    words = parser(__doc__)
    words.add_argument("kind", choices=KINDS)
    words.add_argument("tables", help="separated by commas")
    words.add_argument("out", type=pathlib.Path)
    words.add_argument("--scenes", default="", help="names, separated by commas")
    words.add_argument("--quantities", default="w_n", help="names, separated by commas: " + ", ".join(QUANTITIES))
    words.add_argument("--coverage", action="store_true", help="in panels of its own")
    given = words.parse_args()
    KINDS[given.kind](given)


KINDS = {"failures": draw_failures, "compared": draw_compared, "front": draw_front, "coverage": draw_coverage, "atlas": draw_atlas}

if __name__ == "__main__":
    main()
