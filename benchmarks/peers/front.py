#!/usr/bin/env python3
"""Accuracy against CPU time for slipfit, reduced slipfit settings, and own implementations of other methods.

front.py SLIPFIT FOLDER [--count N] [--csv FILE] [--scenes A,B]    measures recordings; FOLDER is written by benchmarks/independent/make.py scenes
front.py SLIPFIT FOLDER --sweeps [--count N] [--csv FILE]          measures alpha of sweeps; FOLDER is written by make.py sweeps
front.py --draw FILE[,FILE] --out CHART.svg [--quantities k,alpha] [--scenes A,B] [--coverage]   draws what was measured

The time is CPU time: that of slipfit's command minus that of its start, that of the other methods without reading the
file. The error is the median of the relative errors. The coverage is the share of the 95 % intervals that contain the
truth; a fit by scipy has the intervals of its own covariance. Needs python3-scipy, drawing needs python3-matplotlib.
"""

import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy

SCENES = {"plain": "no deviation from the model", "scatter30": "static friction scatters by 30 %", "noisy": "noise",
          "mains_drifting": "hum and drift", "boxcar": "the sensor averages", "weakening": "friction weakens over a distance",
          "reload": "force rises after a slip", "ageing": "static friction ages", "exponential_strong": "sweeps of five speeds"}
# name: (title, key in the fit document, key in the truth)
QUANTITIES = {"k": ("stiffness k", "stiffness_N_per_m", "stiffness_N_per_m"),
              "spacing": ("spacing V/f", "pattern_spacing_m", "spacing_m"),
              "w_n": ("natural frequency ω$_n$", "natural_frequency_rad_per_s", "natural_frequency_rad_per_s"),
              "zeta": ("damping ratio ζ", "damping_ratio", "damping_ratio"),
              "alpha": ("velocity dependence α", "alpha_s_per_m", "alpha_s_per_m")}
OF_A_RECORDING = ("k", "spacing", "w_n", "zeta")
DEFAULT = "slipfit fit"
METHODS = {  # name: (colour, marker)
    DEFAULT: ("#000000", "o"),
    "slipfit, a third of the cycles": ("#0072b2", "v"),
    "slipfit, every fourth sample": ("#56b4e9", "s"),
    "slipfit --tier damped": ("#009e73", "D"),
    "features of the slips": ("#777777", "x"),
    "scipy, whole trace": ("#d55e00", "^"),
    "scipy, cycles as blocks": ("#e69f00", "P"),
}


def read_estimate(document, key):
    estimate = (document.get("parameters") or {}).get(key) or (document.get("derived") or {}).get(key) or {}
    return estimate.get("value"), estimate.get("ci95")


def run_command(slipfit, *words):
    """CPU seconds of a command without those of the program's start, and its document; None if it fails."""
    import compare
    start_s, _ = compare.run(slipfit, "--version")
    try:
        whole_s, text = compare.run(slipfit, "fit", *words, "--json", "--quiet")
    except subprocess.CalledProcessError:
        return None
    return whole_s - start_s, json.loads(text)


def command(slipfit, file, truth, *options):
    done = run_command(slipfit, str(file), "--speed", f"{truth['speed_m_per_s']:.9g}", *options)
    if done is None:
        return None
    return done[0], {name: read_estimate(done[1], QUANTITIES[name][1]) for name in OF_A_RECORDING}


def third(slipfit, file, truth):
    slips_s = truth["slips_s"]
    count = max(8, len(slips_s) // 3)
    return command(slipfit, file, truth, "--window", f"{slips_s[0]:.9g}:{slips_s[min(count, len(slips_s) - 1)]:.9g}")


def thinned(file):
    lines = pathlib.Path(file).read_text().splitlines()
    return "\n".join([lines[0], *lines[1::4]]) + "\n"


def every_fourth(slipfit, file, truth):
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as thin:
        thin.write(thinned(file))
        thin.flush()
        return command(slipfit, thin.name, truth)


def load(file, truth):
    """Samples in the time of a drive at compare.SPEED: forces are unchanged, frequencies larger by the ratio."""
    import compare
    rows = numpy.loadtxt(file, delimiter=",", skiprows=1)
    first, last = truth["slips_s"][0], truth["slips_s"][-1]
    rows = rows[(rows[:, 0] >= first) & (rows[:, 0] <= last)]
    ratio = truth["speed_m_per_s"] / compare.SPEED
    return rows[:, 0] * ratio, rows[:, 1], ratio


def features(_, file, truth):
    """Medians over the slips: the slope between them (k), their distance (spacing), the fall from 80 to 20 % as half a cosine (w_n)."""
    import compare
    time_s, force, ratio = load(file, truth)
    begin = compare.time.process_time()
    period = (time_s[-1] - time_s[0]) / (len(truth["slips_s"]) - 1)
    high, low = numpy.percentile(force, (98.0, 2.0))
    drop, step = high - low, (time_s[-1] - time_s[0]) / (len(time_s) - 1)
    near = max(2, int(0.25 * period / step))
    falls = []
    middle = numpy.flatnonzero((force[:-1] >= 0.5 * (high + low)) & (force[1:] < 0.5 * (high + low)))
    for i in middle:
        piece = force[max(0, i - near): i + near]
        above = numpy.flatnonzero(piece > high - 0.2 * drop)
        above = above[above < min(near, i)]
        below = numpy.flatnonzero(piece < low + 0.2 * drop)
        below = below[below > min(near, i)]
        if len(above) and len(below):
            falls.append((below[0] - above[-1]) * step)
    omega = 2.0 * numpy.arcsin(0.6) / max(numpy.median(falls), 0.5 * step) * ratio if falls else None
    place = numpy.flatnonzero((force > high - 0.3 * drop) | (force < low + 0.3 * drop))
    is_low = force[place] < low + 0.3 * drop
    onsets_s = time_s[place[:-1][~is_low[:-1] & is_low[1:]]]  # last sample near the peak before one near the trough
    spacing = numpy.mean(numpy.diff(onsets_s)) * compare.SPEED if len(onsets_s) > 1 else None
    lag = max(1, int(0.1 * period / step))
    stiffness = numpy.median(force[lag:] - force[:-lag]) / (lag * step * compare.SPEED)  # most of the time it sticks
    seconds = compare.time.process_time() - begin
    return seconds, {"k": (stiffness, None), "spacing": (spacing, None), "w_n": (omega, None), "zeta": (None, None)}


def with_interval(result, place, factor):
    """A parameter of a fit by scipy and the interval of its covariance, both times a factor."""
    value = result.x[place] * factor
    try:
        covariance = numpy.linalg.inv(result.jac.T @ result.jac) * 2.0 * result.cost / (len(result.fun) - len(result.x))
    except numpy.linalg.LinAlgError:
        return value, None
    reach = 1.96 * numpy.sqrt(max(0.0, covariance[place, place])) * factor
    return value, [value - reach, value + reach]


def parameters_of(result, ratio):
    return {name: with_interval(result, place, factor) for name, place, factor in (("k", 0, 1.0), ("w_n", 1, ratio), ("zeta", 2, 1.0))}


def whole_trace(_, file, truth):
    import compare
    time_s, force, ratio = load(file, truth)
    seconds, result = compare.fit_with_search(time_s, force)
    spacing = compare.SPEED * compare.cycle_of(*result.x[:4])[4] / result.x[1]
    return seconds, {**parameters_of(result, ratio), "spacing": (spacing, None)}


def blocks(_, file, truth):
    import compare
    time_s, force, ratio = load(file, truth)
    begin = compare.time.process_time()
    model = compare.Blocks(compare.searched_start(time_s, force), time_s)
    seconds = compare.time.process_time() - begin
    fit_s, result = compare.fit(model, model.start, time_s, force, max_nfev=30)
    onsets_s = result.x[4:4 + model.count]
    spacing = compare.SPEED * numpy.mean(numpy.diff(onsets_s[1:-1])) if model.count > 3 else None  # the outer cycles are cut off
    return seconds + fit_s, {**parameters_of(result, ratio), "spacing": (spacing, None)}


RUN = dict(zip(METHODS, (command, third, every_fourth, lambda s, f, t: command(s, f, t, "--tier", "damped"), features,
                         whole_trace, blocks)))


def joint(slipfit, folder, _):
    done = run_command(slipfit, "--joint", str(folder / "manifest.csv"))
    return None if done is None else (done[0], {"alpha": read_estimate(done[1], "alpha_s_per_m")})


def joint_every_fourth(slipfit, folder, truth):
    with tempfile.TemporaryDirectory() as name:
        thin = pathlib.Path(name)
        (thin / "manifest.csv").write_text((folder / "manifest.csv").read_text())
        for file in folder.glob("run*.csv"):
            (thin / file.name).write_text(thinned(file))
        return joint(slipfit, thin, truth)


def exponential_through(folder, truth, sliding):
    """alpha of F_k(v) = f0 + f1 exp(alpha v) through the kinetic friction of each recording at its fastest sliding speed.

    `sliding` gives the CPU time of one recording, its fastest sliding speed and its kinetic friction."""
    import compare
    from scipy.optimize import curve_fit
    seconds, speeds, frictions = 0.0, [], []
    for i, speed in enumerate(truth["speeds_m_per_s"]):
        spent, fastest, friction = sliding(folder / f"run{i}.csv", speed)
        seconds += spent
        speeds.append(fastest)
        frictions.append(friction)
    begin = compare.time.process_time()
    v, f = numpy.array(speeds), numpy.array(frictions)
    try:
        (_, _, alpha), covariance = curve_fit(lambda v, f0, f1, alpha: f0 + f1 * numpy.exp(alpha * v), v, f,
                                              p0=(f[-1], f[0] - f[-1], -2.0 / numpy.mean(v)), maxfev=2000)
    except RuntimeError:
        return seconds + compare.time.process_time() - begin, {"alpha": (None, None)}
    reach = 1.96 * numpy.sqrt(covariance[2, 2])
    interval = [alpha - reach, alpha + reach] if numpy.isfinite(reach) else None
    return seconds + compare.time.process_time() - begin, {"alpha": (alpha, interval)}


def sliding_by_features(file, speed):
    """Undamped slip: kinetic friction midway between peak and trough, fastest sliding half the drop times w_n/k."""
    import compare
    rows = numpy.loadtxt(file, delimiter=",", skiprows=1)
    slope_lag = max(1, len(rows) // 2000)
    begin = compare.time.process_time()
    time_s, force = rows[len(rows) // 10:, 0], rows[len(rows) // 10:, 1]
    high, low = numpy.percentile(force, (98.0, 2.0))
    step = time_s[1] - time_s[0]
    fastest_fall = -numpy.min(force[slope_lag:] - force[:-slope_lag]) / (slope_lag * step)
    rise = numpy.median(force[slope_lag:] - force[:-slope_lag]) / (slope_lag * step)
    return compare.time.process_time() - begin, speed * (1.0 + fastest_fall / rise), 0.5 * (high + low)


def sliding_by_whole_trace(file, speed):
    import compare
    rows = numpy.loadtxt(file, delimiter=",", skiprows=1)
    rows = rows[len(rows) // 10:]
    seconds, result = compare.fit_with_search(rows[:, 0] * speed / compare.SPEED, rows[:, 1])
    k, omega, _, drop, level, _ = result.x
    return seconds, speed * (1.0 + omega * drop / (k * compare.SPEED)), level


SWEEP_RUN = {DEFAULT: joint,
             "slipfit, every fourth sample": joint_every_fourth,
             "features of the slips": lambda s, f, t: exponential_through(f, t, sliding_by_features),
             "scipy, whole trace": lambda s, f, t: exponential_through(f, t, sliding_by_whole_trace)}


def true_value(truth, quantity):
    key = QUANTITIES[quantity][2]
    return truth["spacing_m"] if quantity == "spacing" else truth["parameters"].get(key)


def rows_of(scene, method, answers, truths, quantities):
    """Rows of the table, one for each quantity; an answer is None if the method failed."""
    times_ms = [1e3 * answer[0] for answer in answers if answer is not None]
    for quantity in quantities:
        errors, held = [], []
        known = [(answer[1].get(quantity, (None, None)), true_value(truth, quantity))
                 for answer, truth in zip(answers, truths) if answer is not None and true_value(truth, quantity)]
        for (value, interval), true in known:
            if value is not None:
                errors.append(abs(value / true - 1.0))
            if interval is not None:
                held.append(min(interval) <= true <= max(interval))
        enough = 2 * len(errors) > len(truths)
        yield [scene, method, quantity, len(truths), len(errors), f"{numpy.median(times_ms):.4g}" if times_ms else "",
               f"{numpy.median(errors):.4g}" if enough else "", f"{numpy.mean(held):.3f}" if held else ""]


def measure(arguments):
    truths = [json.loads(line) for line in open(arguments.folder / "truth.jsonl", encoding="utf-8")]
    out = csv.writer(arguments.csv, lineterminator="\n")
    out.writerow(["scene", "method", "quantity", "recordings", "answered", "median_cpu_ms", "median_error", "covered"])
    methods = SWEEP_RUN if arguments.sweeps else RUN
    for scene in arguments.scenes.split(",") if arguments.scenes else dict.fromkeys(t["family"] for t in truths):
        chosen = [t for t in truths if t["family"] == scene][: arguments.count]
        for method, run in methods.items():
            answers = []
            for truth in chosen:
                place = truth["id"] if arguments.sweeps else truth["file"]
                try:
                    answers.append(run(arguments.slipfit, arguments.folder / place, truth))
                except (ValueError, TypeError, IndexError, RuntimeError, MemoryError):  # the search found no start
                    answers.append(None)
            out.writerows(rows_of(scene, method, answers, chosen, ("alpha",) if arguments.sweeps else OF_A_RECORDING))
            arguments.csv.flush()


def staircase(points):
    """The Pareto front: no point has less error for less time."""
    front = []
    for x, y in sorted(points):
        if not front or y < front[-1][1]:
            front += [(x, front[-1][1]), (x, y)] if front else [(x, y)]
    return front


def mark(axes, row, y):
    colour, marker = METHODS[row["method"]]
    is_default = row["method"] == DEFAULT
    axes.plot([float(row["median_cpu_ms"])], [y], marker, color=colour, markersize=9 if is_default else 6.5, linestyle="none",
              zorder=4 if is_default else 3)


def draw_error(axes, rows):
    known = [r for r in rows if r["median_error"]]
    front = staircase([(float(r["median_cpu_ms"]), float(r["median_error"])) for r in known])
    if front:
        axes.plot([x for x, _ in front] + [axes.get_xlim()[1]], [y for _, y in front] + [front[-1][1]], "--", color="#999999",
                  linewidth=1.2, zorder=1)
    for row in known:
        mark(axes, row, float(row["median_error"]))


def name_coverage(axes, rows):
    """The coverage of the default and of other methods as text next to their marks."""
    for row in rows:
        if not row["covered"] or not row["median_error"] or (row["method"].startswith("slipfit") and row["method"] != DEFAULT):
            continue
        at = {DEFAULT: (-4, -14), "scipy, whole trace": (-20, 8)}.get(row["method"], (-2, 8))
        axes.annotate(f"{100.0 * float(row['covered']):.0f} %", (float(row["median_cpu_ms"]), float(row["median_error"])),
                      textcoords="offset points", xytext=at, fontsize=8, color=METHODS[row["method"]][0])


def draw_coverage(axes, rows):
    axes.axhline(0.95, color="#999999", linewidth=1.0, zorder=1)
    for row in rows:
        if row["covered"]:
            mark(axes, row, float(row["covered"]))


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
    times = [float(r["median_cpu_ms"]) for r in rows if r["median_error"]]
    errors = [float(r["median_error"]) for r in rows if r["median_error"]]
    return (min(times) / 3.0, max(times) * 4.0), (min(errors) / 8.0, max(errors) * 8.0)


def draw(arguments):
    """Rows of panels: a scene (with the coverage as text, or in panels of its own) over the quantities."""
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "slipfit", "svg.fonttype": "none", "font.size": 9})
    from matplotlib import pyplot
    rows = [row for name in arguments.draw.split(",") for row in csv.DictReader(open(name, encoding="utf-8"))]
    quantities = arguments.quantities.split(",")
    scenes = arguments.scenes.split(",") if arguments.scenes else [s for s in SCENES if any(r["scene"] == s for r in rows)]
    panels = [(s, q, [r for r in rows if r["scene"] == s and r["quantity"] == q]) for s in scenes for q in quantities]
    panels = [panel for panel in panels if any(r["median_error"] for r in panel[2])]
    limits = limits_of([row for panel in panels for row in panel[2]])
    across = min(4, len(panels)) if len(quantities) == 1 else len(quantities)
    if len(quantities) > 1:  # a column for each quantity, a row for each scene that has the first one
        rows_of_scenes = [s for s, q, _ in panels if q == quantities[0]]
        places = {rows_of_scenes.index(s) * across + quantities.index(q) if s in rows_of_scenes else quantities.index(q): (s, q, mine)
                  for s, q, mine in panels}
        panels = [places.get(i) for i in range(max(places) + 1)]
    kinds = 2 if arguments.coverage else 1
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
        title = SCENES[scene] if len(quantities) == 1 else f"{QUANTITIES[quantity][0]}\n{SCENES[scene]}"
        panel.set_title(title, fontsize=9.5 if across < 4 else 8)
        if column == 0:
            panel.set_ylabel("median relative error")
        if kinds == 1:
            name_coverage(panel, mine)
            continue
        panel = axes[line + 1][column]
        set_axes(panel, False, limits)
        draw_coverage(panel, mine)
        if column == 0:
            panel.set_ylabel("coverage of the\n95 % intervals")
    for line, row_of_axes in enumerate(axes):
        for column, panel in enumerate(row_of_axes):
            if line + 1 == down or not axes[line + 1][column].get_visible():
                panel.set_xlabel("CPU time [ms]")
                panel.tick_params(labelbottom=True)
    used = {row["method"] for panel in panels if panel for row in panel[2] if row["median_error"]}
    marks = [pyplot.Line2D([], [], color=c, marker=m, linestyle="none", label=name) for name, (c, m) in METHODS.items() if name in used]
    marks.append(pyplot.Line2D([], [], color="#999999", linestyle="--",
                               label="Pareto front" if kinds == 2 else "Pareto front;  %: coverage of the intervals"))
    figure.legend(handles=marks, loc="lower center", ncol=4, fontsize=8, frameon=False, columnspacing=1.2, handletextpad=0.4)
    figure.tight_layout(rect=(0.0, 0.55 / height, 1.0, 1.0))
    figure.savefig(arguments.out, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("slipfit", nargs="?")
    parser.add_argument("folder", nargs="?", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=20, help="recordings of a scene")
    parser.add_argument("--sweeps", action="store_true", help="measure sweeps")
    parser.add_argument("--csv", type=argparse.FileType("w"), default=sys.stdout)
    parser.add_argument("--draw", help="tables, separated by commas")
    parser.add_argument("--out", default="front.svg")
    parser.add_argument("--scenes", default="", help="names, separated by commas")
    parser.add_argument("--quantities", default="w_n", help="names, separated by commas: " + ", ".join(QUANTITIES))
    parser.add_argument("--coverage", action="store_true", help="in panels of its own")
    arguments = parser.parse_args()
    return draw(arguments) if arguments.draw else measure(arguments)


if __name__ == "__main__":
    main()
