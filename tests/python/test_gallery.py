"""The notebooks of the gallery run, and show no error."""

import json
import os
import subprocess
import sys

import pytest
from conftest import PROJECT

NOTEBOOKS = sorted((PROJECT / "docs" / "gallery").glob("*.ipynb"))


@pytest.fixture(scope="module")
def executed(tmp_path_factory):
    """The folder with all notebooks as one run left them."""
    pytest.importorskip("nbconvert")
    folder = tmp_path_factory.mktemp("gallery")
    run = subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output-dir", str(folder), *map(str, NOTEBOOKS)],
                         capture_output=True, text=True, env={**os.environ, "JUPYTER_PLATFORM_DIRS": "1", "PYTHONWARNINGS": "ignore"}, check=False)
    assert run.returncode == 0, run.stderr[-3000:]
    return folder


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda notebook: notebook.stem)
def test_notebooks(notebook, executed):
    cells = [cell for cell in json.loads((executed / notebook.name).read_text())["cells"] if cell["cell_type"] == "code"]
    assert all(cell["execution_count"] for cell in cells)
    assert any(cell["outputs"] for cell in cells)


def test_notebooks_are_kept_without_results():
    assert len(NOTEBOOKS) == 6
    for notebook in NOTEBOOKS:
        cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
        assert not any(cell.get("outputs") or cell.get("execution_count") for cell in cells), notebook.name
