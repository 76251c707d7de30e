#!/usr/bin/env python3
"""remedies.py [--check]: writes src/core/remedies.hpp from the tables of errors in docs/formats.md; --check: exit 1 where it is not so."""

import pathlib
import re
import sys

PROJECT = pathlib.Path(__file__).resolve().parents[1]
TARGET = PROJECT / "src" / "core" / "remedies.hpp"


def remedies():
    text = (PROJECT / "docs" / "formats.md").read_text(encoding="utf-8")
    section = text[text.index("\n## Errors\n") :]
    found = {}
    for line in section.splitlines():
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]
        if len(cells) == 4 and cells[0].startswith("`"):
            for code in re.findall(r"`(\w+)`", cells[0]):
                found.setdefault(code, cells[3].replace("`", ""))
    return found


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def header():
    table = sorted(remedies().items())
    rows = "".join(f"    Remedy{{{quoted(code)}, {quoted(remedy)}}},\n" for code, remedy in table)
    return f"""#pragma once

#include <array>
#include <string_view>

namespace slipfit {{

struct Remedy {{
  std::string_view code, remedy;
}};

// clang-format off
/// What to do about each error; made by scripts/remedies.py from docs/formats.md.
constexpr std::array<Remedy, {len(table)}> kRemedies{{{{
{rows}}}}};
// clang-format on

}}  // namespace slipfit
"""


def main():
    made = header()
    if "--check" in sys.argv[1:]:
        if not TARGET.exists() or TARGET.read_text(encoding="utf-8") != made:
            sys.exit("src/core/remedies.hpp is not what docs/formats.md says: run scripts/remedies.py")
        return
    TARGET.write_text(made, encoding="utf-8")


main()
