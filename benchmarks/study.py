"""What the studies share: command lines, runs of the program, truths of recordings, and tables of counts."""
import argparse
import collections
import concurrent.futures
import json
import os
import resource
import statistics
import subprocess
import time


def parser(description):
    return argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)


def run(program, *words, timeout=300):
    """The document of a command of slipfit; its status is `refused` or `timeout` where there is none."""
    try:
        done = subprocess.run([program, *map(str, words), "--json"], capture_output=True, text=True, check=False, timeout=timeout)
    except subprocess.TimeoutExpired:
        return {"status": "timeout"}
    return json.loads(done.stdout) if done.returncode == 0 else {"status": "refused", "message": done.stderr.strip()}


def is_answer(document):
    return document.get("status") not in ("refused", "timeout")


Cost = collections.namedtuple("Cost", "wall_s cpu_s peak_MB code out error")


def cost(*words, limit_s=None):
    """What a command takes, its start included, and what it prints. The peak is at least that of this program. `limit_s`: of processor time."""
    limit = None if limit_s is None else lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit_s, limit_s))
    begun = time.perf_counter()
    process = subprocess.Popen(list(map(str, words)), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=limit)
    out, error = process.stdout.read(), process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return Cost(time.perf_counter() - begun, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024.0, process.returncode, out, error)


def in_parallel(jobs, function, items):
    """Results in the order of the items. For functions that wait for a program."""
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        return list(pool.map(function, items))


def read_truths(folder, families=""):
    """Rows of FOLDER/truth.jsonl, of all families or of these."""
    with open(folder / "truth.jsonl", encoding="utf-8") as lines:
        truths = [json.loads(line) for line in lines]
    return [truth for truth in truths if not families or truth["family"] in families.split(",")]


class Row(collections.defaultdict):
    """What one recording adds to each column of a table."""

    def __init__(self, **values):
        super().__init__(list)
        for column, value in values.items():
            self.add(column, value)

    def add(self, column, value):
        if value is not None:
            self[column].append(value)


def share(values):
    return f"{sum(values)}/{len(values)}" if values else "-"


def total(values):
    return f"{sum(values)}"


def median(values):
    return f"{statistics.median(values):.3g}" if values else "-"


def counts(values):
    return " ".join(f"{name}:{count}" for name, count in sorted(collections.Counter(values).items()))


def print_table(columns, groups, name="family", whole="all"):
    """A line for each group of rows, and one for all. `columns`: how the values of each are summed up, or whose values and how. Columns that no
    row has are left out."""
    rows = [row for group in groups.values() for row in group]
    columns = {title: how if isinstance(how, tuple) else (title, how) for title, how in columns.items()}
    columns = {title: of for title, of in columns.items() if any(row[of[0]] for row in rows)}
    lines = [[name, *columns]]
    for group, members in [*groups.items(), *([(whole, rows)] if whole else [])]:
        lines.append([str(group), *(how([value for row in members for value in row[column]]) for column, how in columns.values())])
    widths = [max(map(len, column)) for column in zip(*lines)]
    for cells in lines:
        print(cells[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(cells[1:], widths[1:])))
