#!/usr/bin/env python3
"""completion.py SLIPFIT: what bash, zsh and fish complete with the files that scripts/manual.py makes. Skips a shell that is not installed."""
import os
import pathlib
import pty
import re
import select
import shutil
import signal
import subprocess
import sys
import tempfile

PROJECT = pathlib.Path(__file__).resolve().parents[2]
# line typed, words that are offered, words that are not
CASES = [
    ("slipfit ", ["analyze", "fit", "surface"], ["--speed"]),
    ("slipfit pre", ["predict"], ["plan"]),
    ("slipfit fit --sp", ["--speed", "--speed-uncertainty"], ["--seed"]),
    ("slipfit compare --", ["--a", "--group"], ["--tier"]),
    ("slipfit fit --tier ", ["weakening", "velocity"], ["run7.csv"]),
    ("slipfit fit --force-view ", ["spring", "contact"], ["run7.csv"]),
    ("slipfit simulate --drift ", ["run7.csv"], ["sensor"]),
    ("slipfit fit ru", ["run7.csv"], ["merge"]),
    ("slipfit ru", ["run7.csv"], ["merge"]),
]


def bash(made, folder, lines):
    """What the function offers, and file names where that is nothing, as -o default says."""
    script = 'source "$1"; complete -p slipfit | grep -q -- "-o default" || exit 1; COMP_WORDS=($2); [ "${2% }" = "$2" ] || COMP_WORDS+=(""); ' \
        'COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _slipfit; ' \
        '[ ${#COMPREPLY[@]} -gt 0 ] || COMPREPLY=($(compgen -f -- "${COMP_WORDS[COMP_CWORD]}")); echo "${COMPREPLY[@]}"'
    return [subprocess.run(["bash", "-c", script, "bash", made / "slipfit.bash", line], cwd=folder, capture_output=True, text=True,
                           check=True).stdout for line in lines]


def fish(made, folder, lines):
    script = "; ".join([f"source {made}/slipfit.fish", *(f"complete -C '{line}' | string replace -r '\\t.*' ''; echo =" for line in lines)])
    done = subprocess.run(["fish", "--no-config", "-c", script], cwd=folder, capture_output=True, text=True, check=True,
                          env={**os.environ, "HOME": str(folder)})
    return done.stdout.split("=\n")


def zsh(made, folder, lines):
    """Types each line and Ctrl-D, which lists what may follow."""
    child, terminal = pty.fork()
    if child == 0:
        os.chdir(folder)
        os.execvpe("zsh", ["zsh", "-f", "-i"], {**os.environ, "TERM": "dumb", "HOME": str(folder)})

    def answer(text, mark):
        """The screen up to the mark, and until it rests."""
        os.write(terminal, text.encode())
        screen = ""
        while select.select([terminal], [], [], 0.3 if mark in screen else 20)[0]:
            screen += os.read(terminal, 65536).decode(errors="replace")
        return screen

    answer(f"stty columns 300 rows 200; PS1=; LISTMAX=999; fpath=({made} $fpath); autoload -U compinit; compinit -u -D; echo rea''dy\n", "ready")
    screens = [answer(f"\x15{line}\x04", "\n").partition("\n")[2] for line in lines]
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    os.close(terminal)
    return screens


def main():
    faults, skipped = [], []
    with tempfile.TemporaryDirectory() as name:
        made, folder = pathlib.Path(name) / "made", pathlib.Path(name) / "folder"
        folder.mkdir()
        made.mkdir()
        (folder / "run7.csv").write_text("")
        subprocess.run([sys.executable, PROJECT / "scripts" / "manual.py", sys.argv[1], made], check=True)
        for shell in (bash, zsh, fish):
            if not shutil.which(shell.__name__):
                skipped.append(shell.__name__)
                continue
            for (line, offered, others), answer in zip(CASES, shell(made, folder, [case[0] for case in CASES])):
                words = re.findall(r"[\w.-]+", answer)
                wrong = [w for w in offered if w not in words] + [w for w in others if w in words]
                if wrong:
                    faults.append(f"{shell.__name__}: '{line}' offers {answer!r}: {wrong}")
    print(*faults, sep="\n")
    print("skipped, not installed: " + ", ".join(skipped) if skipped else "bash, zsh and fish complete")
    return 1 if faults else 77 if skipped else 0


sys.exit(main())
