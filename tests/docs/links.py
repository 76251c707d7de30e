#!/usr/bin/env python3
"""links.py PROJECT: every link of README.md, docs/ and the other pages of the checkout leads to a file in it."""
import pathlib
import re
import sys

LINK = re.compile(r"\]\(([^)#\s]+)(#[^)\s]*)?\)")


def dead_links(project):
    pages = [*project.glob("*.md"), *project.glob("docs/**/*.md"), *project.glob("testdata/*.md")]
    for page in sorted(pages):
        text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.S | re.M)
        for match in LINK.finditer(text):
            if "://" not in match[1] and not match[1].startswith("mailto:") and not (page.parent / match[1]).exists():
                yield f"{page.relative_to(project)}: no file: {match[1]}"


found = list(dead_links(pathlib.Path(sys.argv[1])))
print("\n".join(found), file=sys.stderr)
sys.exit(1 if found else 0)
