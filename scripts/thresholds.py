#!/usr/bin/env python3
"""thresholds.py [--check]: docs/thresholds.md from src/core/thresholds.hpp. --check only says whether it is up to date (exit 1)."""

import pathlib
import re
import sys

PROJECT = pathlib.Path(__file__).resolve().parent.parent
SOURCE = PROJECT / "src/core/thresholds.hpp"
TABLE = PROJECT / "docs/thresholds.md"
CONSTANT = re.compile(r"inline constexpr [\w:]+ (k\w+) = ([^;]+);")


def rows(text):
    """Section headings and rows (name, value, meaning, unit, origin) in the order of the file."""
    comment = []
    for line in text[text.index("namespace slipfit::thresholds") :].splitlines():
        if line.startswith("// ## "):
            yield (line[6:].strip(),)
        elif line.startswith("/// "):
            comment.append(line[4:].strip())
        elif match := CONSTANT.match(line):
            meaning, bracket = re.fullmatch(r"(.*?)\s*\[(.*)\]", " ".join(comment)).groups()
            unit, origin = bracket.split("; ", 1)
            yield match.group(1), match.group(2), meaning, unit, origin
            comment = []


def table(text):
    lines = ["# Thresholds", "", "Made by `scripts/thresholds.py` from `src/core/thresholds.hpp`. Change a number there.", ""]
    for row in rows(text):
        if len(row) == 1:
            lines += ["", f"## {row[0]}", "", "| name | value | unit | decides | origin |", "|---|---|---|---|---|"]
        else:
            name, value, meaning, unit, origin = (cell.replace("|", "\\|") for cell in row)
            lines.append(f"| `{name}` | {value} | {unit} | {meaning} | {origin} |")
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)) + "\n"


def main():
    made = table(SOURCE.read_text(encoding="utf-8"))
    if "--check" in sys.argv[1:]:
        if not TABLE.exists() or TABLE.read_text(encoding="utf-8") != made:
            sys.exit("docs/thresholds.md is not what src/core/thresholds.hpp says: run scripts/thresholds.py")
    else:
        TABLE.write_text(made, encoding="utf-8")


main()
