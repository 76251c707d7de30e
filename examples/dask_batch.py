"""Fits the recordings of a manifest on a Dask cluster, and writes one table: the summary.csv of ``slipfit batch``, byte for byte.

    python3 dask_batch.py runs.csv table.csv tcp://scheduler:8786   # without an address: on this machine

The workers need the module slipfit and a disk that they share with this program. A recording that fails is a row with its error.
"""

import csv
import os
import sys

import dask.bag
from dask.distributed import Client

import slipfit as sf

READ = {"speed_m_per_s": "speed", "normal_force_N": "normal_force", "zero_force_N": "zero", "group": "group"}  # add what the manifest has


def row_of(entry, folder):
    """A row of the table. Runs on a worker."""
    file = os.path.join(folder, entry["file"])
    said = {name: entry[column] for column, name in READ.items() if entry.get(column)}
    try:
        row = sf.fit(sf.read_recording(file, **said), name=entry["id"]).row(text=True)
    except sf.Error as error:
        row = {"status": "failed", "error": error.code}
    return {"row": entry["row"], **row, "id": entry["id"], "group": entry.get("group") or "", "file": file}


def rows_of(manifest, client):
    """In the manifest's order. Each recording is a task of its own, so that long ones do not hold others up."""
    with open(manifest, newline="", encoding="utf-8") as stream:
        entries = [{"row": row, **entry} for row, entry in enumerate(csv.DictReader(stream), 1)]
    bag = dask.bag.from_sequence(entries, npartitions=len(entries))
    return client.compute(bag.map(row_of, folder=os.path.dirname(manifest))).result()


def write_table(rows, path):
    names = next((list(row) for row in rows if row["status"] != "failed"), ["row", "id", "group", "file", "status", "error"])
    with open(path, "w", newline="", encoding="utf-8") as stream:
        table = csv.DictWriter(stream, names, lineterminator="\n", restval="")
        table.writeheader()
        table.writerows(rows)


def main(manifest, out, scheduler=None):
    with Client(scheduler) as client:
        rows = rows_of(manifest, client)
    write_table(rows, out)
    failed = [row for row in rows if row["status"] == "failed"]
    print(f"{len(rows) - len(failed)} of {len(rows)} fitted, {len(failed)} failed: {out}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
