#!/usr/bin/env python3
"""site_links.py FOLDER: every link and picture of the HTML files below FOLDER leads to a file there, and every #place to an id in it."""

import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.places, self.links = set(), []

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name == "id" or (name == "name" and tag == "a"):
                self.places.add(value)
            elif name in ("href", "src") and value:
                self.links.append(value)


def pages_below(folder):
    pages = {}
    for file in folder.rglob("*.html"):
        pages[file.resolve()] = page = Page()
        page.feed(file.read_text(encoding="utf-8"))
    return pages


def faults(folder):
    pages = pages_below(folder)
    for file, page in sorted(pages.items()):
        if file.name == "404.html":  # which a server shows at any address
            continue
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (file.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else file
            place = urllib.parse.unquote(parts.fragment)
            if not target.exists():
                yield f"{file.relative_to(folder)}: no file: {link}"
            elif place and target in pages and place not in pages[target].places and not place.startswith("__"):
                yield f"{file.relative_to(folder)}: no such place: {link}"


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    found = list(faults(folder))
    print("\n".join(found), file=sys.stderr)
    count = len(list(folder.rglob("*.html")))
    print(f"{count} pages, {len(found)} broken links")
    sys.exit(1 if found or not count else 0)


main()
