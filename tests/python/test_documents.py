"""Every Python snippet of the documents runs, each document's in their order, among the files that the documents name."""

import importlib.util
import os
import pathlib
import re
import shutil

import pytest
from conftest import PROGRAM, PROJECT, TESTDATA

import slipfit as sf

PAGES = [page for page in sorted((PROJECT / "docs").rglob("*.md")) if "```python" in page.read_text(encoding="utf-8")]


@pytest.fixture(scope="session")
def files(tmp_path_factory):
    """run7.csv, wet.csv, runs.csv and what else the documents use; by the test of their commands."""
    script = PROJECT / "tests" / "docs" / "commands.py"
    spec = importlib.util.spec_from_file_location("commands", script)
    commands = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(commands)
    folder = tmp_path_factory.mktemp("files")
    commands.make_files(os.path.abspath(PROGRAM), folder)
    shutil.copy(TESTDATA / "demo.csv", folder / "demo.csv")
    return folder


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(PROJECT)))
def test_snippets(page, files, tmp_path, monkeypatch, capsys):
    shutil.copytree(files, tmp_path / "here", symlinks=True)
    monkeypatch.chdir(tmp_path / "here")
    if page.name == "formats.md":  # reads a batch that the page speaks of
        sf.batch("runs.csv", out="results")
    names = {"__name__": page.stem}
    text = page.read_text(encoding="utf-8")
    for match in re.finditer(r"^```python\n(.*?)^```(?:\n\nIt prints\n\n```\n(.*?)^```)?", text, re.S | re.M):
        line = text.count("\n", 0, match.start()) + 1
        capsys.readouterr()
        exec(compile("\n" * line + match.group(1), str(page), "exec"), names)
        if match.group(2):
            assert capsys.readouterr().out == match.group(2)


def test_pages_with_snippets_are_found():
    found = {page.name for page in PAGES}
    assert {"python.md", "tutorial.md", "from_scipy.md", "sweep.md"} <= found
    assert pathlib.Path(PROGRAM).exists()
