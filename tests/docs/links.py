#!/usr/bin/env python3
"""links.py PROJECT: every link in the Markdown pages of the checkout leads to a file in it, and every #place to a heading of that file."""
import pathlib
import re
import sys

LINK = re.compile(r"\]\(([^)#\s]*)(#[^)\s]*)?\)")
FOLDERS = ("docs/**", "testdata", "benchmarks/**", "examples/**")


def places_in(page):
    """Anchors of the headings, as GitHub and MkDocs make them from their words."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.S | re.M)
    for heading in re.findall(r"^#+ (.*)$", text, re.M):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        yield re.sub(r"[^\w\- ]", "", words).strip().replace(" ", "-")
    yield from re.findall(r'(?:id|name)="([^"]+)"', text)


def dead_links(project):
    pages = [*project.glob("*.md"), *(page for folder in FOLDERS for page in project.glob(f"{folder}/*.md"))]
    for page in sorted(set(pages)):
        text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.S | re.M)
        for match in LINK.finditer(text):
            if "://" in match[1] or match[1].startswith("mailto:"):
                continue
            target = page.parent / match[1] if match[1] else page
            if not target.exists():
                yield f"{page.relative_to(project)}: no file: {match[1]}"
            elif match[2] and target.suffix == ".md" and match[2][1:] not in set(places_in(target)):
                yield f"{page.relative_to(project)}: no heading: {match[1]}{match[2]}"


found = list(dead_links(pathlib.Path(sys.argv[1])))
print("\n".join(found), file=sys.stderr)
sys.exit(1 if found else 0)
