#!/usr/bin/env python3
"""lint.py [--lower]: what can be checked of the code without compiling it. Prints each breach as file:line, exit 1.

layers     a layer includes only the layers below it
circles    no two files include each other, directly or through others; a header and its .cpp count as one
format     clang-format 14, where it is installed
lengths    functions up to 80 lines, files up to 800
parameters in public headers: no output and no boolean parameters
names      of test cases: no semicolon, at which CMake 3.25 cuts a name into two tests that run nothing and pass
ranges     algorithms of std::ranges that the browser version lacks

Breaches older than their rule are in scripts/lint_allowed.txt as a count by rule and file, which may only decrease: --lower writes the
remaining counts. The last line reports the counts of scripts/language.py and is not checked.
"""

import collections
import pathlib
import re
import shutil
import subprocess
import sys

import language

ALLOWED = {
    "core": set(),
    "io": {"core"},
    "signal": {"core"},
    "model": {"core"},
    "surface": {"core", "io", "signal"},
    "fit": {"core", "signal", "model"},
    "predict": {"core", "model", "fit"},
    "chart": set(),
    "figures": {"core", "model", "chart"},
}
ON_TOP = {"analysis", "compare", "report", "batch", "pipeline"}  # these, and apps/, may include every layer
LAYERS = set(ALLOWED) | ON_TOP
ROOTS = ("src", "include/slipfit")
INCLUDE = re.compile(r'\s*#\s*include\s*[<"](slipfit/)?([\w/]+)\.hpp[>"]')
LONGEST_FUNCTION = 80
LONGEST_FILE = 800

Breach = collections.namedtuple("Breach", "rule file line text")


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


def layer_breaches(project):
    for root in (project / name for name in ROOTS):
        for file in sorted(root.rglob("*.[ch]pp")):
            layer = layer_of(file, root)
            if layer not in LAYERS:
                yield Breach("layers", file, 1, f"unknown layer '{layer}', known: {', '.join(sorted(LAYERS))}")
                continue
            allowed = LAYERS if layer in ON_TOP else ALLOWED[layer] | {layer}
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                included = included_layer(line)
                if included and included not in allowed:
                    yield Breach("layers", file, number, f"layer '{layer}' must not include '{included}'")


def include_graph(project):
    """From "fit/x" (src/fit/x.hpp, src/fit/x.cpp and include/slipfit/fit/x.hpp alike) to what it includes."""
    graph = {}
    for root in (project / name for name in ROOTS):
        for file in sorted(root.rglob("*.[ch]pp")):
            unit = str(file.relative_to(root).with_suffix(""))
            found = (INCLUDE.match(line) for line in file.read_text(encoding="utf-8").splitlines())
            graph.setdefault(unit, set()).update(match.group(2) for match in found if match)
    return {unit: {u for u in included if u in graph and u != unit} for unit, included in graph.items()}


def knots(graph):
    """Sets of files of which each includes every other (strongly connected components, Tarjan)."""
    index, low, stack, found = {}, {}, [], []

    def visit(unit):
        index[unit] = low[unit] = len(index)
        stack.append(unit)
        for other in sorted(graph[unit]):
            if other not in index:
                visit(other)
                low[unit] = min(low[unit], low[other])
            elif other in stack:
                low[unit] = min(low[unit], index[other])
        if low[unit] == index[unit]:
            at = stack.index(unit)
            found.append(sorted(stack[at:]))
            del stack[at:]

    for unit in sorted(graph):
        if unit not in index:
            visit(unit)
    return [knot for knot in found if len(knot) > 1]


def circle_breaches(project):
    """One for each file, all of them under src, so that the files in circles may only become fewer."""
    for knot in knots(include_graph(project)):
        for unit in knot:
            others = ", ".join(other for other in knot if other != unit)
            yield Breach("circles", project / "src", 1, f"{unit} and {others} include each other")


def sources(project):
    folders = ("include", "src", "apps", "python", "tests", "benchmarks")
    return sorted(file for folder in folders for file in (project / folder).rglob("*.[ch]pp"))


def format_breaches(project):
    if not shutil.which("clang-format"):
        return
    version = subprocess.run(["clang-format", "--version"], capture_output=True, text=True, check=True).stdout
    if " 14." not in version:
        return
    run = subprocess.run(["clang-format", "--dry-run", *map(str, sources(project))], capture_output=True, text=True)
    for file, line in re.findall(r"^(.*?):(\d+):\d+: warning", run.stderr, re.M):
        yield Breach("format", pathlib.Path(file), int(line), "not as clang-format writes it")


def without_text(code):
    """Comments, literals and preprocessor lines replaced by blanks, so that braces are braces and lines stay."""
    pattern = r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\])+\'|//[^\n]*|/\*.*?\*/|^[ \t]*#[^\n]*'
    return re.sub(pattern, lambda match: re.sub(r"[^\n]", " ", match.group()), code, flags=re.S | re.M)


def functions(code):
    """First and last line of each function body that is not inside another one."""
    opened, head, line = [], "", 1
    for c in code:
        line += c == "\n"
        if c == "{":
            is_scope = not re.search(r"\)", head) and re.search(r"\b(namespace|class|struct|union|enum|extern)\b", head)
            inside = any(kind == "function" for kind, _ in opened)
            is_function = not is_scope and not inside and re.search(r"\)[^=;]*$", head)
            opened.append(("scope" if is_scope else "function" if is_function else "other", line))
            head = ""
        elif c == "}":
            kind, first = opened.pop() if opened else ("other", line)
            if kind == "function":
                yield first, line
            head = ""
        else:
            head = "" if c == ";" else head + c


def length_breaches(project):
    for file in sources(project):
        if file.relative_to(project).parts[0] not in ("src", "include", "apps", "python"):
            continue
        code = file.read_text(encoding="utf-8")
        lines = code.count("\n")
        if lines > LONGEST_FILE:
            yield Breach("file", file, lines, f"a file of {lines} lines, at most {LONGEST_FILE}")
        for first, last in functions(without_text(code)):
            if last - first + 1 > LONGEST_FUNCTION:
                yield Breach("function", file, first, f"a function of {last - first + 1} lines, at most {LONGEST_FUNCTION}")


def parameter_breaches(project):
    for file in sorted((project / "include").rglob("*.hpp")):
        code = without_text(file.read_text(encoding="utf-8"))
        for match in re.finditer(r"\w\(([^()]*)\)", code):
            number = code.count("\n", 0, match.start()) + 1
            for parameter in re.split(r",(?![^<]*>)", match.group(1)):
                parameter = " ".join(parameter.split())
                if re.match(r"bool \w", parameter):
                    yield Breach("parameters", file, number, f"boolean parameter '{parameter}'")
                if re.match(r"(?!const\b)[\w:<>, ]+[&*] ?\w+$", parameter):
                    yield Breach("parameters", file, number, f"output parameter '{parameter}'")


def name_breaches(project):
    for file in sorted((project / "tests").rglob("*.cpp")):
        code = file.read_text(encoding="utf-8")
        for match in re.finditer(r'TEST_CASE\(\s*((?:"[^"]*"\s*)+)', code):
            if ";" in match.group(1):
                yield Breach("names", file, code.count("\n", 0, match.start()) + 1, "a semicolon in the name of a test case")


def range_breaches(project):
    """The C++ library of the browser version has no algorithms of std::ranges but those that cmake/web adds."""
    added = (project / "cmake/web/missing_ranges.hpp").read_text(encoding="utf-8")
    known = set(re.findall(r"^constexpr \w+ (\w+)\(", added, re.M))
    for root in (project / name for name in ROOTS):
        for file in sorted(root.rglob("*.[ch]pp")):
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                for name in re.findall(r"std::ranges::(\w+)\(", line):
                    if name not in known:
                        yield Breach("ranges", file, number, f"std::ranges::{name} is not in cmake/web/missing_ranges.hpp")


def allowed_counts(file):
    """Lines "rule file count"."""
    lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
    rows = (line.split() for line in lines if line and not line.startswith("#"))
    return {(rule, name): int(count) for rule, name, count in rows}


def write_counts(file, counts):
    rows = [f"{rule} {name} {count}" for (rule, name), count in sorted(counts.items()) if count > 0]
    file.write_text("\n".join(["# rule, file, count: what scripts/lint.py lets pass; counts may only shrink", *rows, ""]))


def main():
    project = pathlib.Path(__file__).resolve().parents[1]
    list_file = project / "scripts" / "lint_allowed.txt"
    rules = (layer_breaches, circle_breaches, format_breaches, length_breaches, parameter_breaches, name_breaches, range_breaches)
    found = collections.defaultdict(list)
    for breach in (breach for rule in rules for breach in rule(project)):
        found[(breach.rule, str(breach.file.relative_to(project)))].append(breach)
    allowed = allowed_counts(list_file)
    if "--lower" in sys.argv[1:]:
        allowed = {key: min(limit, len(found[key])) for key, limit in allowed.items()}
        write_counts(list_file, allowed)
    messages = []
    for key in sorted(set(found) | set(allowed)):
        count, limit = len(found[key]), allowed.get(key, 0)
        if count > limit:
            messages += [f"{key[1]}:{b.line}: {b.rule}: {b.text}" for b in found[key]]
            messages += [f"{key[1]}: {key[0]}: {count}, allowed {limit}"] if limit else []
        elif count < limit:
            messages.append(f"{key[1]}: {key[0]}: only {count} of {limit} left: scripts/lint.py --lower")
    print("\n".join(messages) if messages else f"lint: nothing new; {sum(allowed.values())} allowed")
    print(language.summary(project))  # a report, which fails nothing
    sys.exit(1 if messages else 0)


main()
