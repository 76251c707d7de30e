#!/usr/bin/env python3
"""manual.py SLIPFIT FOLDER: man pages (slipfit.1, slipfit-fit.1, ...) and completion for bash, zsh and fish, all from --help."""

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


class Option:
    """A row of the options of the help: its spellings, whether a value follows, the words it may be ("x|y: ..."), what it is for."""

    def __init__(self, spellings, kind, text):
        self.spellings = spellings.split(",")
        self.long = [s for s in self.spellings if s.startswith("--")]
        self.has_value = bool(re.match(r" [A-Z]", kind))
        choices = re.match(r"([\w|]+\|[\w|]+): ", text)
        self.values = [v for v in choices.group(1).split("|") if v.islower()] if choices else []
        self.text = text[choices.end() :] if choices else text


def commands_of(program):
    """{name: (what it does, its options)}"""
    text = help_of(program)
    commands = {}
    for name, words in re.findall(r"^  (\w+) +(.*)", text[text.index("Subcommands:") :], re.M):
        rows = re.sub(r"\n {20,}", "  ", help_of(program, name)).splitlines()
        commands[name] = (words, [Option(*(g or "" for g in match.groups())) for match in map(OPTION.match, rows) if match])
    return commands


def bash_completion(commands):
    cases = values = ""
    for name, (_, options) in commands.items():
        cases += f'    {name}) words="{" ".join(s for o in options for s in o.long)}" ;;\n'
        values += "".join(f'    "{name} {s}") words="{" ".join(o.values)}" ;;\n' for o in options if o.values for s in o.long)
    return f"""# bash completion for slipfit; readline completes file names where nothing else fits
_slipfit() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" words=""
  COMPREPLY=()
  case "${{COMP_WORDS[1]}} ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{values}  esac
  [[ "$word" == -* ]] && case "${{COMP_WORDS[1]}}" in
{cases}  esac
  [ "$COMP_CWORD" -eq 1 ] && words="{' '.join(commands)} --help --version"
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}}
complete -o default -F _slipfit slipfit
"""


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def zsh_completion(commands):
    def spec(option, spelling):
        text = re.sub(r"([\[\]:\\])", r"\\\1", option.text)
        value = f"({' '.join(option.values)})" if option.values else "_files"
        return quoted(f"*{spelling}=[{text}]:{spelling.strip('-')}:{value}" if option.has_value else f"*{spelling}[{text}]")

    cases = ""
    for name, (_, options) in commands.items():
        specs = " \\\n      ".join(spec(o, s) for o in options for s in o.spellings)
        cases += f"    {name}) _arguments {specs} \\\n      '*:file:_files' ;;\n"
    names = "\n    ".join(quoted(f"{name}:{words}") for name, (words, _) in commands.items())
    return f"""#compdef slipfit
local state line
local -a commands=(
    {names})
_arguments -C '--help[Print the help]' '--version[Print the version]' '1: :->first' '*:: :->rest'
case $state in
first) _describe command commands; _files ;;
rest)
  case $words[1] in
{cases}    *) _files ;;
  esac ;;
esac
"""


def fish_completion(commands):
    lines = ["# fish completion for slipfit"]
    for name, (words, options) in commands.items():
        lines.append(f"complete -c slipfit -n __fish_use_subcommand -a {name} -d {quoted(words)}")
        for option in options:
            spelled = " ".join(f"-{'l' if s in option.long else 's'} {s.strip('-')}" for s in option.spellings)
            value = f" -x -a {quoted(' '.join(option.values))}" if option.values else " -r" if option.has_value else ""
            lines.append(f"complete -c slipfit -n '__fish_seen_subcommand_from {name}' {spelled}{value} -d {quoted(option.text)}")
    return "\n".join(lines) + "\n"


def write_packed(file, text):
    with open(file, "wb") as raw, gzip.GzipFile(fileobj=raw, mode="wb", filename="", mtime=0, compresslevel=9) as packed:
        packed.write(text.encode())


def main():
    program, folder = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2])
    (folder / "man").mkdir(parents=True, exist_ok=True)
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    commands = commands_of(program)
    write_packed(folder / "man" / "slipfit.1.gz", page("slipfit", help_of(program), version))
    for name in commands:
        write_packed(folder / "man" / f"slipfit-{name}.1.gz", page(f"slipfit-{name}", help_of(program, name), version))
    (folder / "slipfit.bash").write_text(bash_completion(commands))
    (folder / "_slipfit").write_text(zsh_completion(commands))
    (folder / "slipfit.fish").write_text(fish_completion(commands))
    project = pathlib.Path(__file__).resolve().parents[1]
    write_packed(folder / "changelog.gz", (project / "CHANGELOG.md").read_text(encoding="utf-8"))


main()
