#!/usr/bin/env python3
"""ablation.py FOLDER CORPUS... [--factor 1e6] [--only kName,kOther] [--out TABLE]: what each threshold of src/core/*thresholds.hpp decides.

Builds the program once in FOLDER from a copy of this tree in which every threshold can be set by an environment variable, and runs
the corpora with one threshold at a time divided and multiplied by the factor, so that its rule always or never acts. A corpus is a
manifest (its groups are fitted together, too) or a folder of make.py scenes, make.py terms, make.py sweeps, or of surface's profiles.py.
Thresholds of sweeps meet sweeps only, those of predictions the predictions from their fits, those of surfaces profiles only, all others the rest.

One line a threshold and direction, against the answers without a change: documents that differ in any way; in the kind of motion, or a
refusal; in the status of a parameter; in a value or interval by more than 0.05 standard errors; in their warnings. Where the truth
is known: right kinds of motion, frequencies within 5 %, intervals that hold the truth and that do not, identified and far off, terms taken
that are not there (more or fewer than without the change). Last the processor time over that without the change."""
import collections
import csv
import json
import os
import pathlib
import re
import resource
import subprocess
import sys

PROJECT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(PROJECT / "benchmarks/independent"))
from evaluate import SHORT, score_motion  # noqa: E402
from study import parser, read_truths  # noqa: E402

CONSTANT = re.compile(r"inline constexpr ([\w:]+) (k\w+) = ([^;]+);")
CONVERT = """#include <cstdlib>
namespace slipfit::thresholds {
inline double set_from_outside(const char* name, double value) {
  const char* text = std::getenv(name);
  return text ? std::strtod(text, nullptr) : value;
}
}  // namespace slipfit::thresholds
"""
BOUND = 0.05  # of a standard error
PREDICTED = (0.5, 1, 1.4, 2, 4, 8, 30, 200)  # times the fastest recording
KIND_OF = {"Sweeps": "sweeps", "Predictions": "predictions", "Pattern on a worn surface": "profiles"}  # by section
OF_SWEEPS = ("kKnownRate", "kWidestFactor", "kLeastSpeedRatio", "kSamplesOfFall", "kAverageOfSwing")


def build(folder):
    """The program whose thresholds the environment sets; and each threshold's header section, type and value."""
    tree = folder / "tree"
    if not tree.exists():
        tree.mkdir(parents=True)
        archive = subprocess.run(["git", "-C", PROJECT, "archive", "HEAD"], check=True, capture_output=True).stdout
        subprocess.run(["tar", "-x", "-C", tree], input=archive, check=True)
        for header in tree.glob("src/core/*thresholds.hpp"):
            changed = CONSTANT.sub(lambda m: f'inline const {m[1]} {m[2]} = static_cast<{m[1]}>(set_from_outside("SLIPFIT_THRESHOLD_{m[2]}", {m[3]}));',
                                   header.read_text())
            header.write_text(changed.replace("#include <cstddef>\n", '#include <cstddef>\n#include "core/set_from_outside.hpp"\n', 1))
        (tree / "src/core/set_from_outside.hpp").write_text("#pragma once\n" + CONVERT)
        for source in list(tree.glob("src/**/*.cpp")) + list(tree.glob("src/**/*.hpp")):
            text = source.read_text()
            if "thresholds.hpp" not in source.name and "thresholds::" in text:
                source.write_text(re.sub(r"constexpr( \w+ k\w+ = [^;]*thresholds::)", r"const\1", text))
    settings = ["-DSLIPFIT_INSTALL=OFF", "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"]
    subprocess.run(["cmake", "--preset", "tool", *settings], cwd=tree, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", "build/tool", "--parallel", "1"], cwd=tree, check=True, stdout=subprocess.DEVNULL)
    return tree / "build/tool/apps/slipfit"


def thresholds():
    """Section and value of each by its name."""
    found, section = {}, ""
    for header in sorted((PROJECT / "src/core").glob("*thresholds.hpp")):
        for line in header.read_text().splitlines():
            section = line[6:].strip() if line.startswith("// ## ") else section
            if match := CONSTANT.match(line):
                found[match[2]] = (section, eval(match[3], {}, {name: value for name, (_, value) in found.items()}))
    return found


class Corpus:
    """Recordings, sweeps or profiles that one command answers, with what is known of them."""

    def __init__(self, path, folder):
        self.truths, self.manifest, self.profiles = {}, path, []
        if path.is_dir():
            rows = read_truths(path)
            self.truths = {row.get("id", row.get("file")): row for row in rows if "kind" in row}
            self.profiles = [path / row["file"] for row in rows if "file" in row and "speed_m_per_s" not in row]
            self.manifest = folder / f"{path.name}.csv"
            with open(self.manifest, "w", newline="") as out:
                writer = csv.writer(out)
                writer.writerow(["id", "file", "speed_m_per_s", "normal_force_N", "group"])
                for row in rows if not self.profiles else []:
                    writer.writerows([row["id"], (path / row["file"]).resolve(), row["speed_m_per_s"], "", ""] for _ in range("file" in row))
                    writer.writerows([f"{row['id']}/{run['id']}".replace("/", "."), (path / row["id"] / run["file"]).resolve(), run["speed_m_per_s"],
                                      run.get("normal_force_N", ""), row["id"]] for run in self.runs(path, row))
        with open(self.manifest) as text:
            self.is_sweep = any(row.get("group") for row in csv.DictReader(text))
        self.kind = "profiles" if self.profiles else "sweeps" if self.is_sweep else "recordings"

    @staticmethod
    def runs(path, row):
        return [] if "file" in row else csv.DictReader(open(path / row["id"] / "manifest.csv"))


def documents(program, corpus, folder, environment):
    """The answers by id; refusals are texts."""
    if corpus.kind == "profiles":
        done = {p.name: subprocess.run([program, "surface", p, "--json", "--quiet"], capture_output=True, text=True, env=environment) for p in corpus.profiles}
        return {name: json.loads(d.stdout) if d.returncode == 0 else d.stderr for name, d in done.items()}
    subprocess.run(["rm", "-rf", folder / "out"], check=True)
    command = [program, "batch", corpus.manifest, "--out", folder / "out", "--joint-groups", "--quiet", "--jobs", "1", "--timeout", "20"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=300)
    except subprocess.TimeoutExpired:
        return {"all": "too slow"}
    if done.returncode not in (0, 1):
        return {"all": done.stderr}
    failures = (folder / "out/failures.csv").read_text().splitlines()[1:]
    answers = {d["id"]: d for d in map(json.loads, (folder / "out/results.jsonl").read_text().splitlines())}
    return answers | {line.split(",")[0]: line for line in failures}


def predictions(program, fits, folder, environment):
    """Predictions and plans from fits of sweeps at speeds within and beyond theirs."""
    answers = {}
    for name, fit in fits.items():
        speeds = [] if isinstance(fit, str) else [r["recording"]["speed_m_per_s"] for r in fit.get("recordings", []) if r.get("recording")]
        if not speeds:
            continue
        (folder / "fit.json").write_text(json.dumps(fit))
        at = ",".join(f"{times * max(speeds):.9g}" for times in PREDICTED)
        for command in (["predict", folder / "fit.json", "--speeds", at], ["plan", folder / "fit.json"]):
            done = subprocess.run([program, *command, "--json", "--quiet"], capture_output=True, text=True, env=environment)
            answers[f"{name} {command[0]}"] = json.loads(done.stdout) if done.returncode == 0 else done.stderr
    return answers


def numbers(value, path=""):
    """Every estimate of a document (a value with an interval) by its path."""
    if isinstance(value, dict):
        if "ci95" in value or "ci95_Hz" in value:
            yield path, value
        for key, part in value.items():
            yield from numbers(part, f"{path}/{key}")
    elif isinstance(value, list):
        for i, part in enumerate(value):
            yield from numbers(part, f"{path}/{i}")


def moved(one, other):
    value, interval = ("value_Hz", "ci95_Hz") if "ci95_Hz" in one else ("value", "ci95")
    a, b = [[e.get(value), *(e.get(interval) or [None, None])] for e in (one, other)]
    unit = one.get("se") or (0.25 * (a[2] - a[1]) if None not in a[1:] else abs(a[0] or 0.0))
    return any((x is None) != (y is None) or (x is not None and abs(x - y) > BOUND * unit) for x, y in zip(a, b))


def difference(one, other):
    """Which of the things told differ."""
    if one == other:
        return []
    if isinstance(one, str) or isinstance(other, str) or one.get("status") != other.get("status"):
        return ["any", "motion"]
    mine, theirs = dict(numbers(one)), dict(numbers(other))
    told = ["any"]
    if any(mine[k].get("status") != theirs[k].get("status") for k in mine.keys() & theirs.keys()) or mine.keys() != theirs.keys():
        told.append("status")
    if any(moved(mine[k], theirs[k]) for k in mine.keys() & theirs.keys()):
        told.append("value")
    codes = [sorted(w["code"] for w in d.get("warnings", []) if isinstance(w, dict)) for d in (one, other)]
    return told + (["warnings"] if codes[0] != codes[1] else [])


def profile_scores(document, truth):
    """right: a spacing within 5 %, or none of a control; wrong: an interval of less than 10 % that is far off."""
    spacing = {} if isinstance(document, str) else document["spacing_m"]
    value, (low, high), true = spacing.get("value"), spacing.get("ci95") or (0.0, 0.0), 1e-6 * (truth.get("spacing_um") or 0.0)
    if value is None:
        return {"right": truth["kind"] == "control"}
    is_narrow, is_off = 0.5 * (high - low) < 0.1 * value, abs(value - true) > high - low
    if truth["kind"] == "control":
        return {"wrong": is_narrow}
    return {"right": abs(value / true - 1) < 0.05, "holds": low <= true <= high, "misses": not low <= true <= high, "wrong": is_narrow and is_off}


def scores(answers, truths):
    """Counts against the truth, over recordings with one."""
    total = collections.Counter()
    for name, truth in truths.items():
        document = answers.get(name, "missing")
        if "speed_m_per_s" not in truth:
            total.update(profile_scores(document, truth))
            continue
        row = score_motion({"status": "refused:" + ("reciprocating" if "stroke" in document else "other")} if isinstance(document, str) else document, truth)
        held = [value for symbol in SHORT.values() for value in row[symbol]]
        total.update({"right": sum(row["verdict"]), "f": sum(row["f 5 %"]), "extra": sum(row["extra"]), "holds": sum(held),
                      "misses": len(held) - sum(held), "wrong": sum(sum(row[symbol + " !!"]) for symbol in SHORT.values())})
    return total


def answered(program, corpora, kind, folder, environment):
    """Documents by corpus, the scores, and the processor time."""
    begun = resource.getrusage(resource.RUSAGE_CHILDREN)
    answers, total = {}, collections.Counter()
    for i, corpus in enumerate(c for c in corpora if c.kind == kind):
        mine = documents(program, corpus, folder, environment)
        total += scores(mine, corpus.truths) if corpus.truths else {}
        answers |= {f"{i}:{name}": document for name, document in mine.items()}
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    return answers, total, ended.ru_utime + ended.ru_stime - begun.ru_utime - begun.ru_stime


def main():
    words = parser(__doc__)
    words.add_argument("folder", type=pathlib.Path)
    words.add_argument("corpora", type=pathlib.Path, nargs="*")
    words.add_argument("--factor", type=float, default=1e6)
    words.add_argument("--only", default="")
    words.add_argument("--out", type=pathlib.Path)
    given = words.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    program, plain = build(given.folder), {k: v for k, v in os.environ.items() if not k.startswith("SLIPFIT_")}
    corpora = [Corpus(path, given.folder) for path in given.corpora]
    before = {kind: answered(program, corpora, kind, given.folder, plain) for kind in sorted({c.kind for c in corpora})}
    fits = {name: document for name, document in before.get("sweeps", ({},))[0].items() if "group:" in name}
    if fits:
        before["predictions"] = (predictions(program, fits, given.folder, plain), collections.Counter(), 1.0)
    out = open(given.out, "a") if given.out else sys.stdout
    print("# " + "; ".join(f"{kind}: {len(b[0])} documents, {b[2]:.1f} s, {dict(b[1])}" for kind, b in before.items()), file=out)
    titles, truth = ["any", "motion", "status", "value", "warnings"], ["right", "f", "holds", "misses", "wrong", "extra"]
    print(f"{'threshold':24} {'value':>9} " + " ".join(f"{t:>8}" for t in titles) + " | " + " ".join(f"{t:>6}" for t in truth) + " |  time", file=out)
    for name, (section, value) in thresholds().items():
        kind = "sweeps" if name in OF_SWEEPS else KIND_OF.get(section, "recordings")
        if kind not in before or (given.only and name not in given.only.split(",")):
            continue
        for moved_to in (value / given.factor, value * given.factor):
            environment = plain | {f"SLIPFIT_THRESHOLD_{name}": repr(moved_to)}
            if kind == "predictions":
                after = (predictions(program, fits, given.folder, environment), collections.Counter(), 1.0)
            else:
                after = answered(program, corpora, kind, given.folder, environment)
            names = before[kind][0].keys() | after[0].keys()
            counts = collections.Counter(d for n in names for d in difference(before[kind][0].get(n, ""), after[0].get(n, "")))
            gains = [after[1][t] - before[kind][1][t] for t in truth]
            print(f"{name:24} {moved_to:9.2g} " + " ".join(f"{counts[t] or '-':>8}" for t in titles) + " | " +
                  " ".join(f"{gain:+6d}" if gain else "     -" for gain in gains) + f" | {after[2] / before[kind][2]:5.2f}", file=out, flush=True)


main()
