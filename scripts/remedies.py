#!/usr/bin/env python3
"""remedies.py [--check]: writes python/slipfit/_remedies.py from the tables of errors in docs/formats.md; --check: exit 1 where it is not so."""

import pathlib
import re
import sys

PROJECT = pathlib.Path(__file__).resolve().parents[1]
TARGET = PROJECT / "python" / "slipfit" / "_remedies.py"


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


def module():
    rows = "".join(f"    {code!r}: {remedy!r},\n".replace("'", '"') if "'" not in remedy and '"' not in remedy else f"    {code!r}: {remedy!r},\n"
                   for code, remedy in sorted(remedies().items()))
    return ('"""What to do about each error; made by scripts/remedies.py from docs/formats.md."""\n\n'
            f"from typing import Dict\n\nREMEDIES: Dict[str, str] = {{\n{rows}}}\n")


def main():
    made = module()
    if "--check" in sys.argv[1:]:
        if not TARGET.exists() or TARGET.read_text(encoding="utf-8") != made:
            sys.exit("python/slipfit/_remedies.py is not what docs/formats.md says: run scripts/remedies.py")
        return
    TARGET.write_text(made, encoding="utf-8")


main()
