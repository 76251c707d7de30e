"""The command that comes with the module, and what is packed."""

import os
import re
import shutil
import subprocess
import sys
import tarfile

import pytest
from conftest import PROGRAM, PROJECT, TESTDATA


def test_the_module_runs_the_program():
    words = ["fit", str(TESTDATA / "demo.csv"), "--speed", "10mm/s", "--json"]
    ours = subprocess.run([sys.executable, "-m", "slipfit", *words], capture_output=True, check=False)
    theirs = subprocess.run([PROGRAM, *words], capture_output=True, check=False)
    assert ours.returncode == 0 and ours.stdout == theirs.stdout
    assert subprocess.run([sys.executable, "-m", "slipfit", "fit", "absent.csv"], capture_output=True, check=False).returncode == 3


def test_a_script_is_no_program(tmp_path, monkeypatch):
    import slipfit.__main__ as command

    package = tmp_path / "lib" / "python3" / "dist-packages" / "slipfit"
    package.mkdir(parents=True)
    (tmp_path / "bin").mkdir()
    script = tmp_path / "bin" / "slipfit"
    monkeypatch.setattr(command, "__file__", str(package / "__main__.py"))
    script.write_text("#!/usr/bin/python3\n")
    script.chmod(0o755)
    assert command.program() is None
    with pytest.raises(SystemExit, match="install it"):
        command.main()
    script.unlink()
    script.symlink_to(os.path.realpath(PROGRAM))
    assert command.program() == script


@pytest.fixture(scope="module")
def sdist(tmp_path_factory):
    """Made of a copy of what the repository tracks, as a user would of a clone."""
    if shutil.which("git") is None:
        pytest.skip("git is not installed")
    listed = subprocess.run(["git", "-C", str(PROJECT), "ls-files", "-z"], capture_output=True, text=True, check=False)
    if listed.returncode != 0:
        pytest.skip("the sources are no git repository")
    folder = tmp_path_factory.mktemp("sources")
    subprocess.run(["cp", "--parents", "-t", str(folder), *(f for f in listed.stdout.split("\0") if f and (PROJECT / f).exists())], cwd=PROJECT, check=True)
    script = "import sys; sys.path.insert(0, 'python/packaging'); import slipfit_backend; slipfit_backend.build_sdist(sys.argv[1])"
    run = subprocess.run([sys.executable, "-c", script, str(folder / "dist")], cwd=folder, capture_output=True, text=True, check=False)
    if "scripts/install_dependencies.sh build python" in run.stderr:
        pytest.skip("neither scikit-build-core nor scikit-build is installed")
    assert run.returncode == 0, run.stderr
    return tarfile.open(next((folder / "dist").glob("*.tar.gz")))


def test_the_sdist_has_all_sources(sdist):
    names = {name.partition("/")[2] for name in sdist.getnames()}
    listed = subprocess.run(["git", "-C", str(PROJECT), "ls-files"], capture_output=True, text=True, check=True).stdout.splitlines()
    missing = {name for name in listed if (PROJECT / name).exists()} - names
    assert all(name.startswith((".ci/", ".git")) for name in missing), sorted(missing)[:10]


def test_the_metadata(sdist):
    info = next(name for name in sdist.getnames() if name.endswith("/PKG-INFO") and name.count("/") == 1)
    text = sdist.extractfile(info).read().decode()
    version = re.search(r"project\(slipfit[^)]*VERSION ([0-9.]+)", (PROJECT / "CMakeLists.txt").read_text()).group(1)
    for expected in (f"Version: {version}", "Author: the slipfit authors", "License: MIT AND GPL-3.0-only", "Classifier: Typing :: Typed",
                     "Provides-Extra: parquet"):
        assert expected in text, expected
