#!/usr/bin/env python3
"""language.py [FOLDER...]: counts words of the project's former jargon and documentation comments without a verb.

A report for people who edit texts, not a check: it always ends with 0. Without folders it reads src, include and apps.
"""
import pathlib
import re
import sys

JARGON = ("tell", "tells", "told", "doubt", "doubts", "beyond", "stands", "stand", "beside", "hides", "hopeless", "hangs")
FOLDERS = ["src", "include", "apps"]
SOURCES = {".hpp", ".cpp"}
FRAGMENT = re.compile(r"^\s*/// (Of|Where|Without|With|Which|As|By|Beside|To|For|From|That|Whether|Why|How|What|Empty)\b[^.]*\.?$")


def comments_and_texts(source: str) -> str:
    """The words that people read: comments and string literals."""
    comments = re.findall(r"//[^\n]*", source)
    literals = re.findall(r'"(?:[^"\\\n]|\\.)*"', source)
    return "\n".join(comments + literals)


def count(files: list[pathlib.Path]) -> tuple[dict[str, int], int, int]:
    """How often each word occurs, how many documentation comments there are, and how many begin as a fragment."""
    counts = dict.fromkeys(JARGON, 0)
    comments = fragments = 0
    for file in files:
        source = file.read_text(encoding="utf-8")
        words = re.findall(r"[a-z]+", comments_and_texts(source).lower())
        for word in JARGON:
            counts[word] += words.count(word)
        lines = source.splitlines()
        for i, line in enumerate(lines):
            if not line.lstrip().startswith("///") or (i > 0 and lines[i - 1].lstrip().startswith("///")):
                continue
            comments += 1
            fragments += FRAGMENT.match(line) is not None
    return counts, comments, fragments


def files_in(folders: list[str], root: pathlib.Path = pathlib.Path()) -> list[pathlib.Path]:
    return [file for folder in folders for file in sorted((root / folder).rglob("*")) if file.suffix in SOURCES]


def summary(root: pathlib.Path) -> str:
    """One line for scripts/lint.py, which reports it and fails for none of it."""
    counts, comments, fragments = count(files_in(FOLDERS, root))
    return f"language: {sum(counts.values())} words of jargon, {fragments} of {comments} documentation comments are fragments"


def main(folders: list[str]) -> None:
    files = files_in(folders)
    counts, comments, fragments = count(files)
    print(f"{len(files)} files in {', '.join(folders)}")
    for word, number in sorted(counts.items(), key=lambda row: -row[1]):
        print(f"{number:6d}  {word}")
    print(f"{fragments:6d}  of {comments} documentation comments begin as a fragment")


if __name__ == "__main__":
    main(sys.argv[1:] or FOLDERS)
