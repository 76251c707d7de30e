#!/usr/bin/env python3
"""plot_coverage.py SUMMARY... --out SVG: coverage of the 95 % intervals as benchmarks/coverage prints it, one row a family,
one column a parameter; bars hold 95 % of the chance that the number of recordings leaves (Wilson)."""

import argparse
import math
import pathlib

PARAMETERS = ["k", "dF", "w_n", "zeta", "spacing"]
LOW, HIGH = 80.0, 100.0
LEFT, TOP, COLUMN, ROW, GAP = 170, 50, 150, 22, 25


def read_rows(files):
    """{family: {parameter: (given, percent inside)}} from the lines of the summaries."""
    rows = {}
    for file in files:
        for line in pathlib.Path(file).read_text(encoding="utf-8").splitlines():
            parts = line.replace("!", " ").split()
            place = next((i for i, part in enumerate(parts) if part in PARAMETERS), 0)
            if not 0 < place < 3 or len(parts) < place + 4:
                continue
            family = " ".join(parts[:place])
            if family != "pooled" or len(files) == 1 or family not in rows or parts[place] not in rows[family]:
                rows.setdefault(family, {})[parts[place]] = (float(parts[place + 2]), float(parts[place + 3]))
    return rows


def wilson(count, percent):
    share, z = percent / 100.0, 1.96
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z / (1 + z * z / count) * math.sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    return 100.0 * (middle - half), 100.0 * (middle + half)


def draw(rows):
    def at(column, percent):
        share = (min(max(percent, LOW), HIGH) - LOW) / (HIGH - LOW)
        return LEFT + column * (COLUMN + GAP) + COLUMN * share

    width = LEFT + len(PARAMETERS) * (COLUMN + GAP)
    height = TOP + ROW * len(rows) + 30
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    for column, parameter in enumerate(PARAMETERS):
        out.append(f'<text x="{at(column, 90)}" y="20" text-anchor="middle" font-weight="bold">{parameter}</text>')
        for percent in (80, 85, 90, 95, 100):
            x = at(column, percent)
            colour = "#c33" if percent == 95 else "#ddd"
            out.append(f'<line x1="{x}" x2="{x}" y1="{TOP - 8}" y2="{height - 25}" stroke="{colour}"/>')
            out.append(f'<text x="{x}" y="{TOP - 12}" text-anchor="middle" font-size="9" fill="#666">{percent}</text>')
    for row, (family, parameters) in enumerate(rows.items()):
        y = TOP + ROW * row + 8
        out.append(f'<text x="{LEFT - 10}" y="{y + 4}" text-anchor="end">{family}</text>')
        for parameter, (count, percent) in parameters.items():
            column = PARAMETERS.index(parameter)
            low, high = wilson(count, percent)
            out.append(f'<line x1="{at(column, low):.1f}" x2="{at(column, high):.1f}" y1="{y}" y2="{y}" stroke="#247" stroke-width="2"/>')
            out.append(f'<circle cx="{at(column, percent):.1f}" cy="{y}" r="3.5" fill="#247"/>')
    out.append(f'<text x="{LEFT}" y="{height - 8}" fill="#666">truth inside the 95 % interval, % of the recordings</text></svg>')
    return "\n".join(out) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("summaries", nargs="+")
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    pathlib.Path(arguments.out).write_text(draw(read_rows(arguments.summaries)), encoding="utf-8")


if __name__ == "__main__":
    main()
