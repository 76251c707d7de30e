#!/usr/bin/env python3
"""Error over time of slipfit, of reductions of it and of other fits, on recordings that bend the model in one way each.

front.py SLIPFIT FOLDER [--count N] [--csv FILE] [--scenes A,B]   measures; FOLDER as benchmarks/independent/make_scenes.py writes it
front.py --draw FILE --out CHART.svg [--scenes A,B] [--coverage]   draws what was measured

Time is processor time: of slipfit's command less that of its start, of the others without reading the file. Error: of
the natural frequency, half of the recordings have a smaller one. Covered: share of the 95 % intervals that hold the
truth; a fit by scipy has those of its own covariance. Needs python3-scipy, drawing python3-matplotlib.
"""

import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy

SCENES = {"plain": "as the model", "scatter30": "static friction scatters by 30 %", "noisy": "noise",
          "mains_drifting": "hum and drift", "boxcar": "the sensor averages", "weakening": "friction weakens over a distance",
          "reload": "force rises after a slip", "ageing": "static friction ages"}
FREQUENCY = "natural_frequency_rad_per_s"
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


def command(slipfit, file, truth, *options):
    import compare
    start_s, _ = compare.run(slipfit, "--version")
    try:
        whole_s, text = compare.run(slipfit, "fit", str(file), "--speed", f"{truth['speed_m_per_s']:.9g}", "--json", "--quiet", *options)
    except subprocess.CalledProcessError:
        return None
    estimate = (json.loads(text).get("parameters") or {}).get(FREQUENCY) or {}
    return whole_s - start_s, estimate.get("value"), estimate.get("ci95")


def third(slipfit, file, truth):
    slips_s = truth["slips_s"]
    count = max(8, len(slips_s) // 3)
    return command(slipfit, file, truth, "--window", f"{slips_s[0]:.9g}:{slips_s[min(count, len(slips_s) - 1)]:.9g}")


def every_fourth(slipfit, file, truth):
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as thin:
        lines = pathlib.Path(file).read_text().splitlines()
        thin.write("\n".join([lines[0], *lines[1::4]]) + "\n")
        thin.flush()
        return command(slipfit, thin.name, truth)


def load(file, truth):
    """In time of a drive at compare.SPEED: forces are the same, frequencies by the ratio larger."""
    import compare
    rows = numpy.loadtxt(file, delimiter=",", skiprows=1)
    first, last = truth["slips_s"][0], truth["slips_s"][-1]
    rows = rows[(rows[:, 0] >= first) & (rows[:, 0] <= last)]
    ratio = truth["speed_m_per_s"] / compare.SPEED
    return rows[:, 0] * ratio, rows[:, 1], ratio


def features(_, file, truth):
    """The frequency that the fall from 80 to 20 % of the usual slip tells: half a cosine."""
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
    seconds = compare.time.process_time() - begin
    if not falls:
        return seconds, None, None
    return seconds, 2.0 * numpy.arcsin(0.6) / max(numpy.median(falls), 0.5 * step) * ratio, None


def with_interval(seconds, result, ratio):
    try:
        covariance = numpy.linalg.inv(result.jac.T @ result.jac) * 2.0 * result.cost / (len(result.fun) - len(result.x))
    except numpy.linalg.LinAlgError:
        return seconds, result.x[1] * ratio, None
    reach = 1.96 * numpy.sqrt(max(0.0, covariance[1, 1]))
    return seconds, result.x[1] * ratio, [(result.x[1] - reach) * ratio, (result.x[1] + reach) * ratio]


def whole_trace(_, file, truth):
    import compare
    time_s, force, ratio = load(file, truth)
    return with_interval(*compare.fit_with_search(time_s, force), ratio)


def blocks(_, file, truth):
    import compare
    time_s, force, ratio = load(file, truth)
    begin = compare.time.process_time()
    model = compare.Blocks(compare.searched_start(time_s, force), time_s)
    seconds = compare.time.process_time() - begin
    fit_s, result = compare.fit(model, model.start, time_s, force, max_nfev=30)
    return with_interval(seconds + fit_s, result, ratio)


RUN = dict(zip(METHODS, (command, third, every_fourth, lambda s, f, t: command(s, f, t, "--tier", "damped"), features,
                         whole_trace, blocks)))


def row_of(scene, method, answers, truths):
    """answers: of the recordings, None where there was no answer."""
    errors, held, times_ms = [], [], []
    for answer, truth in zip(answers, truths):
        if answer is None:
            continue
        seconds, value, interval = answer
        times_ms.append(1e3 * seconds)
        if value is not None:
            errors.append(abs(value / truth["parameters"][FREQUENCY] - 1.0))
        if interval is not None:
            held.append(interval[0] <= truth["parameters"][FREQUENCY] <= interval[1])
    known = 2 * len(errors) > len(truths)
    return [scene, method, len(truths), len(errors), f"{numpy.median(times_ms):.4g}" if times_ms else "",
            f"{numpy.median(errors):.4g}" if known else "", f"{numpy.mean(held):.3f}" if held else ""]


def measure(arguments):
    truths = [json.loads(line) for line in open(arguments.folder / "truth.jsonl", encoding="utf-8")]
    out = csv.writer(arguments.csv, lineterminator="\n")
    out.writerow(["scene", "method", "recordings", "answered", "median_cpu_ms", "median_error", "covered"])
    for scene in arguments.scenes.split(",") if arguments.scenes else SCENES:
        chosen = [t for t in truths if t["family"] == scene][: arguments.count]
        for method, run in RUN.items():
            answers = []
            for truth in chosen:
                try:
                    answers.append(run(arguments.slipfit, arguments.folder / truth["file"], truth))
                except (ValueError, TypeError, IndexError, RuntimeError, MemoryError):  # the search found no start
                    answers.append(None)
            out.writerow(row_of(scene, method, answers, chosen))
            arguments.csv.flush()


def staircase(points):
    """Nothing lies left of and below it."""
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
    axes.plot([x for x, _ in front] + [axes.get_xlim()[1]], [y for _, y in front] + [front[-1][1]], "--", color="#999999",
              linewidth=1.2, zorder=1)
    for row in known:
        mark(axes, row, float(row["median_error"]))


def name_coverage(axes, rows):
    """Of the default and of the fits by others, beside their errors."""
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


def set_axes(axes, is_error):
    from matplotlib.ticker import FixedLocator, LogLocator, NullFormatter
    axes.set(xscale="log", xlim=(0.05, 2e4))
    axes.xaxis.set_major_locator(FixedLocator([10.0**power for power in range(-1, 5)]))
    axes.xaxis.set_minor_formatter(NullFormatter())
    if is_error:
        axes.set(yscale="log", ylim=(1e-4, 5.0))
        axes.yaxis.set_major_locator(LogLocator(numticks=8))
    else:
        axes.set(ylim=(-0.05, 1.08))
    axes.grid(True, color="#e4e4e4", linewidth=0.6)


def draw(arguments):
    """Errors with the coverage in words, or a row of panels for each."""
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "slipfit", "svg.fonttype": "none", "font.size": 9})
    from matplotlib import pyplot
    rows = list(csv.DictReader(open(arguments.draw, encoding="utf-8")))
    scenes = arguments.scenes.split(",") if arguments.scenes else [s for s in SCENES if any(r["scene"] == s for r in rows)]
    across = min(4, len(scenes))
    kinds = 2 if arguments.coverage else 1
    down = kinds * -(-len(scenes) // across)
    height = 2.5 * down + 0.6
    figure, axes = pyplot.subplots(down, across, figsize=(8.9, height), sharex=True, sharey="row", squeeze=False)
    for index, scene in enumerate(scenes):
        column, line = index % across, kinds * (index // across)
        mine = [r for r in rows if r["scene"] == scene]
        panel = axes[line][column]
        set_axes(panel, True)
        draw_error(panel, mine)
        panel.set_title(SCENES[scene], fontsize=9.5 if across < 4 else 8)
        if column == 0:
            panel.set_ylabel("error of the\nnatural frequency")
        if kinds == 1:
            name_coverage(panel, mine)
            continue
        panel = axes[line + 1][column]
        set_axes(panel, False)
        draw_coverage(panel, mine)
        if column == 0:
            panel.set_ylabel("95 % intervals\nthat hold the truth")
    for panel in axes[-1]:
        panel.set_xlabel("processor time  [ms]")
    marks = [pyplot.Line2D([], [], color=c, marker=m, linestyle="none", label=name) for name, (c, m) in METHODS.items()]
    marks.append(pyplot.Line2D([], [], color="#999999", linestyle="--",
                               label="front" if kinds == 2 else "front;  %: intervals that hold the truth"))
    figure.legend(handles=marks, loc="lower center", ncol=4, fontsize=8, frameon=False, columnspacing=1.2, handletextpad=0.4)
    figure.tight_layout(rect=(0.0, 0.5 / height, 1.0, 1.0))
    figure.savefig(arguments.out, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("slipfit", nargs="?")
    parser.add_argument("folder", nargs="?", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=20, help="recordings of a scene")
    parser.add_argument("--csv", type=argparse.FileType("w"), default=sys.stdout)
    parser.add_argument("--draw")
    parser.add_argument("--out", default="front.svg")
    parser.add_argument("--scenes", default="", help="names, separated by commas")
    parser.add_argument("--coverage", action="store_true", help="in panels of its own")
    arguments = parser.parse_args()
    return draw(arguments) if arguments.draw else measure(arguments)


if __name__ == "__main__":
    main()
