#!/usr/bin/env python3
"""check_layers.py [PROJECT]: a layer includes only the layers below it. Prints each breach as file:line, exit 1."""

import pathlib
import re
import sys

ALLOWED = {
    "core": set(),
    "io": {"core"},
    "signal": {"core"},
    "model": {"core"},
    "fit": {"core", "signal", "model"},
    "predict": {"core", "model", "fit"},
    "chart": set(),
    "figures": {"core", "model", "chart"},
}
ON_TOP = {"report", "batch", "pipeline"}  # these, and apps/, may include every layer
LAYERS = set(ALLOWED) | ON_TOP
INCLUDE = re.compile(r'\s*#\s*include\s*[<"](slipfit/)?([\w/]+)\.hpp[>"]')


def layer_of(file, root):
    """src/fit/x.cpp and include/slipfit/fit/x.hpp are of the layer fit; files of no folder are of the pipeline."""
    parts = file.relative_to(root).parts
    return parts[0] if len(parts) > 1 else "pipeline"


def included_layer(line):
    """The layer that a line includes, or None; "names.hpp" without a folder is of the file's own folder."""
    match = INCLUDE.match(line)
    if not match:
        return None
    folder, _, name = match.group(2).partition("/")
    if name:
        return folder if folder in LAYERS else None
    return "pipeline" if match.group(1) else None


def breaches(root):
    for file in sorted(root.rglob("*.[ch]pp")):
        layer = layer_of(file, root)
        if layer not in LAYERS:
            yield f"{file}: unknown layer '{layer}', known: {', '.join(sorted(LAYERS))}"
            continue
        allowed = LAYERS if layer in ON_TOP else ALLOWED[layer] | {layer}
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            included = included_layer(line)
            if included and included not in allowed:
                yield f"{file}:{number}: layer '{layer}' must not include '{included}'"


def main():
    project = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1])
    found = [breach for root in ("src", "include/slipfit") for breach in breaches(project / root)]
    print("\n".join(found) if found else "layers: every include is allowed")
    sys.exit(1 if found else 0)


main()
