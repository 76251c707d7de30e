#!/usr/bin/env python3
"""site_pages.py SLIPFIT FOLDER: what mkdocs makes the site of: docs/, commands by --help, keys by the schema, Python by its docstrings, and the
executed gallery, the public headers by Doxygen (into build/site-source, as scripts/Doxyfile says). PYTHONPATH holds the module."""

import inspect
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import slipfit

PROJECT = pathlib.Path(__file__).resolve().parents[1]
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)#\s]+)(#[^)\s]*)?\)")


def help_of(program, *words):
    return subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True).stdout


def commands_page(program):
    text = help_of(program)
    names = re.findall(r"^  (\w+) ", text[text.index("Subcommands:") :], re.M)
    page = ["# Commands and options", "", "By `--help` of this version.", "", "```text", text.strip(), "```", ""]
    for name in names:
        page += [f"## slipfit {name}", "", "```text", help_of(program, name).strip(), "```", ""]
    return "\n".join(page)


def keys_of(schema, definitions, place=""):
    """(key, type, meaning) of each property, those within it behind it."""
    seen = schema
    while "$ref" in seen:
        seen = definitions[seen["$ref"].split("/")[-1]]
    for name, part in seen.get("properties", {}).items():
        inner = part
        while "$ref" in inner:
            inner = definitions[inner["$ref"].split("/")[-1]]
        kind = inner.get("type", "one of several" if "oneOf" in inner or "anyOf" in inner else "value")
        kind = " or ".join(kind) if isinstance(kind, list) else kind
        yield place + name, kind, part.get("description", inner.get("description", ""))
        if "properties" in inner and place.count(".") < 2:
            yield from keys_of(inner, definitions, f"{place}{name}.")


def from_reference(text):
    """Links of docs/formats.md as a page in docs/reference needs them."""
    return re.sub(r"\]\((?=\w)(?!http)", "](../", text).replace("](#", "](../formats.md#")


def meanings():
    """What docs/formats.md says of each key of a fit that has one row there."""
    text = (PROJECT / "docs" / "formats.md").read_text(encoding="utf-8")
    section = re.search(r"^## Result of `slipfit fit`.*?(?=^## )", text, re.S | re.M).group(0)
    rows = [(key, row.group(2).strip()) for row in re.finditer(r"^\| (`[^|]*) \|(.*)\|$", section, re.M) for key in re.findall(r"`(\w+)`", row.group(1))]
    keys = [key for key, _ in rows]
    return {key: from_reference(meaning) for key, meaning in rows if keys.count(key) == 1 and meaning != "see below"}


def keys_page():
    schema = json.loads((PROJECT / "docs" / "fit.schema.json").read_text(encoding="utf-8"))
    definitions = schema.get("$defs", schema.get("definitions", {}))
    known = meanings()
    rows = [f"| `{key}` | {kind} | {meaning or known.get(key.split('.')[-1], '')} |" for key, kind, meaning in keys_of(schema, definitions)]
    for name, part in definitions.items():
        if "properties" in part:
            rows += [f"| `{name}`: `{key}` | {kind} | {meaning} |" for key, kind, meaning in keys_of(part, definitions)]
    return "\n".join(["# Keys of a fit document", "", "By its schema; what the keys mean in words: [formats](../formats.md).", "",
                      "| key | type | meaning |", "|---|---|---|", *rows, ""])


def markdown_of(docstring):
    """Of a docstring in numpy's style: headings bold, parameters as a list."""
    lines, out, in_list = docstring.splitlines(), [], False
    for number, line in enumerate(lines):
        if line and set(line) == {"-"}:
            continue
        is_heading = number + 1 < len(lines) and lines[number + 1] and set(lines[number + 1]) == {"-"}
        if is_heading:
            in_list = line in ("Parameters", "Returns", "Raises", "Attributes")
            out += ["", f"**{line}**", ""]
        elif in_list and line and not line.startswith(" "):
            out += ["", f"- `{line}`", ""]
        elif in_list and line:
            out.append("    " + line.strip())
        else:
            out.append(line)
    return "\n".join(out).replace("``", "`")


def entry(name, one, level):
    """A function or class by its signature and docstring."""
    try:
        signature = str(inspect.signature(one)).replace("slipfit._cells.", "").replace("'", "")
    except (TypeError, ValueError):
        signature = ""
    text = inspect.cleandoc(one.__doc__ or "")
    return [f"{'#' * level} {name}", "", "```text", f"{name}{signature}" if callable(one) else name, "```", "", markdown_of(text), ""]


def python_page():
    page = ["# Python functions and classes", "", "By the docstrings of this version; a guide with examples: [the Python module](../python.md).", ""]
    functions = [name for name in slipfit.__all__ if inspect.isfunction(getattr(slipfit, name))]
    for name in functions:
        page += entry(name, getattr(slipfit, name), 2)
    for name in slipfit.__all__:
        kind = getattr(slipfit, name)
        if not inspect.isclass(kind):
            continue
        page += entry(name, kind, 2)
        for member, part in vars(kind).items():
            documented = part.fget if isinstance(part, property) else part
            if not member.startswith("_") and getattr(documented, "__doc__", None) and (inspect.isfunction(documented)):
                page += entry(f"{name}.{member}", part if isinstance(part, property) else documented, 3)
    return "\n".join(page)


def cpp_page():
    """The example programs, which tests build and run, and the way to what Doxygen made of the headers."""
    page = ["# The C++ library", "", "By the comments of the public headers (Doxygen): [types](cpp/annotated.html), [functions](cpp/namespaceslipfit.html),",
            "[headers](cpp/files.html).", "", "```cmake", "find_package(slipfit REQUIRED)", "target_link_libraries(app PRIVATE slipfit::slipfit)", "```", "",
            "`#include <slipfit/slipfit.hpp>` is the whole library. Functions that may refuse their input return a `Result`.", ""]
    for name in ("fit_recording.cpp", "sweep_and_predict.cpp", "frequency.cpp", "recording_argument.hpp"):
        page += [f"## examples/{name}", "", "```cpp", (PROJECT / "examples" / name).read_text(encoding="utf-8").strip(), "```", ""]
    return "\n".join(page)


def gallery(folder):
    environment = {name: value for name, value in os.environ.items() if name != "MPLBACKEND"}
    notebooks = sorted(map(str, (PROJECT / "docs" / "gallery").glob("*.ipynb")))
    subprocess.run([sys.executable, "-m", "nbconvert", "--to", "markdown", "--execute", "--log-level", "ERROR", "--output-dir", str(folder / "gallery"),
                    *notebooks], env={**environment, "JUPYTER_PLATFORM_DIRS": "1", "PYDEVD_DISABLE_FILE_VALIDATION": "1"}, check=True)
    for page in (folder / "gallery").glob("*.md"):
        # Tables of pandas come with a style that the site has of its own.
        text = re.sub(r"<style scoped>.*?</style>", "", page.read_text(encoding="utf-8"), flags=re.S)
        page.write_text(text.replace('<table border="1" class="dataframe">', "<table>"), encoding="utf-8")


def without_links_out(page, folder):
    """A notebook becomes the page that is made of it, a link to a file that the site does not hold becomes its name."""
    def kept(match):
        image, text, target, _ = match.groups()
        if target.endswith(".ipynb") and (page.parent / target).with_suffix(".md").exists():
            return f"[{text}]({target[: -len('.ipynb')]}.md)"
        if "://" in target or (page.parent / target).resolve().exists() and (page.parent / target).resolve().is_relative_to(folder.resolve()):
            return match.group(0)
        return match.group(0) if image else f"{text} (`{os.path.normpath(target).lstrip('./')}`)"

    parts = re.split(r"(^```.*?^```)", page.read_text(encoding="utf-8"), flags=re.S | re.M)
    page.write_text("".join(part if part.startswith("```") else LINK.sub(kept, part) for part in parts), encoding="utf-8")


def main():
    program, folder = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(PROJECT / "docs", folder, ignore=shutil.ignore_patterns("*.ipynb"))
    (folder / "extra.css").write_text(".md-typeset table:not([class]) { display: block; overflow-x: auto; }\n"
                                      ".md-typeset table:not([class]) th { min-width: 0; }\n"
                                      ".md-typeset img, .md-typeset svg { max-width: 100%; height: auto; }\n"
                                      ".md-typeset td:first-child code { white-space: nowrap; }\n"
                                      ".md-typeset h2, .md-typeset h3 { overflow-wrap: anywhere; }\n")
    (folder / "reference").mkdir()
    (folder / "reference" / "commands.md").write_text(commands_page(program), encoding="utf-8")
    (folder / "reference" / "keys.md").write_text(keys_page(), encoding="utf-8")
    (folder / "reference" / "python.md").write_text(python_page(), encoding="utf-8")
    (folder / "reference" / "cpp.md").write_text(cpp_page(), encoding="utf-8")
    subprocess.run(["doxygen", "scripts/Doxyfile"], cwd=PROJECT, check=True)
    gallery(folder)
    for page in folder.rglob("*.md"):
        without_links_out(page, folder)


main()
