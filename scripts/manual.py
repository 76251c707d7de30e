#!/usr/bin/env python3
"""manual.py SLIPFIT FOLDER: man pages (slipfit.1, slipfit-fit.1, ...) and the completion for bash, both by --help."""

import gzip
import os
import pathlib
import re
import subprocess
import sys

OPTION = re.compile(r"^  (-[\w,-]+)(.*?)(?:\s{2,}(.*))?$")


def help_of(program, *words):
    return subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True).stdout


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.M)


def page(name, text, version):
    """A page in the sections of the help: its first line, the usage, then lists."""
    lines = text.strip().splitlines()
    out = [f'.TH {name.upper().replace("-", chr(92) + "-")} 1 "" "{version}" "slipfit"', ".SH NAME",
           escaped(f"{name} - {lines[0].rstrip('.')}"), ".SH SYNOPSIS"]
    for line in lines[1:]:
        if line.startswith("Usage:"):
            out += [escaped(line[len("Usage:") :].strip())]
        elif re.match(r"^[A-Z][\w ]+:$", line):
            out += [f".SH {line[:-1].upper()}"]
        elif match := re.match(r"^  (\S.*?)(?:\s{2,}(.*))?$", line):
            out += [".TP", f"\\fB{escaped(match.group(1))}\\fR", escaped(match.group(2) or "")]
        elif line.strip():
            out += [escaped(line.strip())] if line.startswith(" ") else [".PP", escaped(line.strip())]
    if "-" in name:
        out += [".SH SEE ALSO", "slipfit(1)"]
    return "\n".join(line for line in out if line) + "\n"


def names_of(program):
    text = help_of(program)
    return re.findall(r"^  (\w+) ", text[text.index("Subcommands:") :], re.M)


def completion(program, names):
    """Commands and options; file names for all else."""
    cases = ""
    for name in names:
        flags = []
        for line in help_of(program, name).splitlines():
            match = OPTION.match(line)
            flags += re.findall(r"--[\w-]+", match.group(1)) if match else []
        cases += f'    {name}) options="{" ".join(dict.fromkeys(flags))}" ;;\n'
    return f"""# bash completion for slipfit, by --help
_slipfit() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" options=""
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "{' '.join(names)} --help --version" -- "$word")
    return
  fi
  case "${{COMP_WORDS[1]}}" in
{cases}  esac
  if [[ "$word" == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}}
complete -o filenames -F _slipfit slipfit
"""


def write_packed(file, text):
    with open(file, "wb") as raw, gzip.GzipFile(fileobj=raw, mode="wb", filename="", mtime=0, compresslevel=9) as packed:
        packed.write(text.encode())


def main():
    program, folder = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2])
    (folder / "man").mkdir(parents=True, exist_ok=True)
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    names = names_of(program)
    write_packed(folder / "man" / "slipfit.1.gz", page("slipfit", help_of(program), version))
    for name in names:
        write_packed(folder / "man" / f"slipfit-{name}.1.gz", page(f"slipfit-{name}", help_of(program, name), version))
    (folder / "slipfit.bash").write_text(completion(program, names))
    project = pathlib.Path(__file__).resolve().parents[1]
    write_packed(folder / "changelog.gz", (project / "CHANGELOG.md").read_text(encoding="utf-8"))


main()
