#!/usr/bin/env python3
"""evaluate.py SLIPFIT PROFILES [--jobs 2] [--chart FILE.svg]: slipfit surface over the profiles of make_profiles.py against their truth.

Coverage: share of intervals that hold the mean spacing. Wrong: an interval of less than 10 % of the value, off by more than twice that. Controls: those
that get a spacing with an interval of less than 10 %. Marks of machining are patterns with a true spacing, and listed apart. Beside it the peak of
the autocorrelation, the peak of the spectrum, and RSm, on the same profiles, form taken off; all answer always. The chart shows error over time. Needs numpy."""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import resource
import subprocess
import time

import numpy as np


def measured(program, file):
    run = subprocess.run([program, "surface", str(file), "--json"], capture_output=True, text=True, check=False)
    return json.loads(run.stdout) if run.returncode == 0 else {"status": "refused: " + run.stderr.split(": ")[-1][:40], "spacing_m": {"value": None}, "rsm_m": None}


def without_form(z):
    t = np.linspace(-1, 1, len(z))
    return z - np.polyval(np.polyfit(t, z, 2), t)


def by_autocorrelation(z):
    """First maximum behind the first passage through zero, the highest of those above half of it."""
    f = np.fft.rfft(z - z.mean(), 2 * len(z))
    a = np.fft.irfft(np.abs(f) ** 2)[: len(z) // 2]
    below = np.flatnonzero(a < 0)
    if len(below) == 0:
        return np.nan
    return float(below[0] + np.argmax(a[below[0]:]))


def by_spectrum(z):
    power = np.abs(np.fft.rfft((z - z.mean()) * np.hanning(len(z)), 8 * len(z))) ** 2
    first = 8 * 4  # at least four ridges
    return 8 * len(z) / (first + np.argmax(power[first:]))


def interval_of(found):
    spacing = found["spacing_m"]
    if spacing["value"] is None:
        return None
    low, high = spacing["ci95"]
    return spacing["value"] * 1e6, low * 1e6, high * 1e6


def rms(errors):
    errors = np.array([e for e in errors if np.isfinite(e)])
    return float(np.sqrt(np.mean(np.clip(errors, -1, 1) ** 2))) if len(errors) else np.nan


def row(name, cases):
    """cases: (truth, interval or None, RSm, autocorrelation, spectrum)"""
    answers = [(t, i) for t, i, *_ in cases if i]
    held = sum(low <= t <= high for t, (_, low, high) in answers)
    wrong = sum((high - low) / 2 < 0.1 * v and abs(v - t) > high - low for t, (v, low, high) in answers)
    half = np.median([(high - low) / 2 / v for _, (v, low, high) in answers]) if answers else np.nan
    share = held / len(answers) if answers else np.nan
    print(f"{name:<18}{len(cases):>6}{len(answers):>9}{100 * share:>9.1f}{wrong:>7}{100 * half:>8.1f}{100 * rms([i[0] / t - 1 for t, i in answers]):>8.1f}"
          f"{100 * rms([a / t - 1 for t, i, _, a, _ in cases if i]):>8.1f}{100 * rms([p / t - 1 for t, i, _, _, p in cases if i]):>8.1f}"
          f"{100 * rms([r / t - 1 for t, i, r, _, _ in cases if i and r]):>8.1f}")
    return share


def chart(file, methods):
    """Error over time, both logarithmic; methods: name -> (seconds, rms, note)."""
    def x(seconds):
        return 90 + 110 * (np.log10(seconds) + 5)

    def y(error):
        return 300 - 110 * (np.log10(error) + 2)
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" width="720" height="360" font-family="sans-serif" font-size="13">',
             '<rect width="720" height="360" fill="white"/>']
    for k in range(-5, 1):
        parts.append(f'<line x1="{x(10.0**k):.0f}" x2="{x(10.0**k):.0f}" y1="40" y2="310" stroke="#ddd"/>'
                     f'<text x="{x(10.0**k):.0f}" y="328" text-anchor="middle">{ {-5: "10 us", -4: "0.1 ms", -3: "1 ms", -2: "10 ms", -1: "0.1 s", 0: "1 s"}[k]}</text>')
    for error in (0.01, 0.03, 0.1, 0.3, 1.0):
        parts.append(f'<line x1="90" x2="640" y1="{y(error):.0f}" y2="{y(error):.0f}" stroke="#ddd"/>'
                     f'<text x="82" y="{y(error) + 4:.0f}" text-anchor="end">{100 * error:.0f} %</text>')
    for name, (seconds, error, colour) in methods.items():
        parts.append(f'<circle cx="{x(seconds):.0f}" cy="{y(error):.0f}" r="6" fill="{colour}"/><text x="{x(seconds) - 10:.0f}" y="{y(error) + 4:.0f}" text-anchor="end">{name}</text>')
    parts.append('<text x="365" y="350" text-anchor="middle">processor time for a profile</text>'
                 '<text x="90" y="24">rms error of the spacing on the profiles that slipfit answers</text></svg>')
    pathlib.Path(file).write_text("\n".join(parts) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("profiles", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--chart")
    given = parser.parse_args()
    truths = [json.loads(line) for line in open(given.profiles / "truth.jsonl", encoding="utf-8")]
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        results = list(pool.map(lambda t: measured(given.program, given.profiles / t["file"]), truths))
    machined = collections.defaultdict(list)
    cases, taken = [], {"autocorrelation": [], "peak of the spectrum": []}
    controls = collections.defaultdict(lambda: [0, 0, 0])
    for truth, found in zip(truths, results):
        interval = interval_of(found)
        if truth["kind"] == "machined":
            machined[truth["family"]].append((truth["spacing_um"], interval, [w["code"] for w in found.get("warnings", [])]))
            continue
        if truth["kind"] == "control":
            count = controls[truth["family"]]
            count[0] += 1
            count[1] += interval is not None
            count[2] += interval is not None and (interval[2] - interval[1]) / 2 < 0.1 * interval[0]
            continue
        data = np.loadtxt(given.profiles / truth["file"], delimiter=",", skiprows=1)
        pitch, z = (data[-1, 0] - data[0, 0]) / (len(data) - 1), without_form(data[:, 1])
        values = []
        for name, method in (("autocorrelation", by_autocorrelation), ("peak of the spectrum", by_spectrum)):
            began = time.process_time()
            values.append(pitch * method(z))
            taken[name].append(time.process_time() - began)
        rsm = found["rsm_m"] * 1e6 if found["rsm_m"] else None
        cases.append((truth, (truth["spacing_um"], interval, rsm, *values)))
    print(f"{'profiles':<18}{'n':>6}{'answered':>9}{'coverage':>9}{'wrong':>7}{'half':>8}{'rms':>8}{'autoc.':>8}{'spectr.':>8}{'RSm':>8}   (percent)")
    row("all", [c for _, c in cases])
    row("with scatter", [c for t, c in cases if t["scatter"] > 0.001])
    for key, edges in (("scatter", (0, 0.001, 0.1, 0.2, 0.3, 0.41)), ("roughness", (0, 0.001, 0.2, 0.4, 0.6, 0.81)), ("count", (5, 8, 15, 40, 100, 201)),
                       ("per_ridge", (10, 20, 40, 80, 201))):
        for low, high in zip(edges, edges[1:]):
            row(f"{key} {low:g}-{high:g}", [c for t, c in cases if low <= t[key] < high])
    for shape in sorted({t["family"] for t, _ in cases}):
        row(shape, [c for t, c in cases if t["family"] == shape])
    print("\ncontrols                n  any spacing  with an interval below 10 %")
    for family, (n, some, small) in sorted(controls.items()):
        print(f"{family:<18}{n:>7}{some:>13}{small:>12}")
    total = np.sum(list(controls.values()), axis=0) if controls else [0, 0, 0]
    print(f"{'all':<18}{total[0]:>7}{total[1]:>13}{total[2]:>12}")
    print("\npatterns by machining   n  answered  in the interval  within 2 %  told that machining may have left it")
    for family, found in sorted(machined.items()):
        answers = [(t, i, codes) for t, i, codes in found if i]
        print(f"{family:<18}{len(found):>7}{len(answers):>10}{sum(i[1] <= t <= i[2] for t, i, _ in answers):>17}"
              f"{sum(abs(i[0] / t - 1) < 0.02 for t, i, _ in answers):>12}{sum('origin_not_known' in codes for *_, codes in answers):>12}")
    file = given.profiles / truths[0]["file"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    for truth in truths[:100]:
        measured(given.program, given.profiles / truth["file"])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    program_s = (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) / 100
    print(f"\nprocessor time: the whole program {1e3 * program_s:.1f} ms a profile, autocorrelation {1e3 * np.median(taken['autocorrelation']):.2f} ms, "
          f"spectrum {1e3 * np.median(taken['peak of the spectrum']):.2f} ms (numpy, without reading {file.suffix})")
    if given.chart:
        answered = [c for _, c in cases if c[1]]
        chart(given.chart, {
            "slipfit (with interval, program and reading)": (program_s, rms([i[0] / t - 1 for t, i, *_ in answered]), "#0072B2"),
            "autocorrelation": (np.median(taken["autocorrelation"]), rms([a / t - 1 for t, _, _, a, _ in answered]), "#E69F00"),
            "spectrum": (np.median(taken["peak of the spectrum"]), rms([p / t - 1 for t, _, _, _, p in answered]), "#D55E00"),
            "RSm (in slipfit)": (program_s, rms([r / t - 1 for t, _, r, _, _ in answered if r]), "#CC79A7")})


if __name__ == "__main__":
    main()
