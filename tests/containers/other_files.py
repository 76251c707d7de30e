#!/usr/bin/env python3
"""other_files.py SLIPFIT: HDF5 files whose numbers are in another file (external storage, virtual datasets, external links; also a named
pipe) are refused in one line at once, and nothing of the other file appears; and the programs that read HDF5 and images have no right to
open a file once they have read theirs.

The files are made by h5py. Exit 77 where it is missing."""

import os
import pathlib
import subprocess
import sys
import tempfile
import time

SLIPFIT = pathlib.Path(sys.argv[1]).resolve()
SECRET = 4242.125
LONGEST_S = 10


def run(*arguments):
    return subprocess.run([SLIPFIT, *map(str, arguments)], capture_output=True, text=True, timeout=LONGEST_S)


def make_files(folder):
    """[(file, path in it whose numbers are elsewhere)]; each file also holds the vector /time itself."""
    import h5py
    import numpy
    times = numpy.arange(500) * 1e-3
    secret = folder / "secret.bin"
    secret.write_bytes(numpy.full(500, SECRET).tobytes())
    os.mkfifo(folder / "pipe")
    with h5py.File(folder / "other.h5", "w") as file:
        file["force"] = numpy.full(500, SECRET)
    for name, target in (("external.h5", secret), ("pipe.h5", folder / "pipe")):
        with h5py.File(folder / name, "w") as file:
            file["run/time"] = times
            file.create_dataset("run/force", shape=(500,), dtype="f8", external=[(str(target), 0, 4000)])
    for name, most in (("virtual.h5", (500,)), ("endless.h5", (None,))):  # the extents of the latter are those of the other file
        with h5py.File(folder / name, "w", libver="latest") as file:
            file["run/time"] = times
            layout = h5py.VirtualLayout((500,), "f8", maxshape=most)
            layout[:] = h5py.VirtualSource(str(folder / "other.h5"), "force", (500,), maxshape=most)
            file.create_virtual_dataset("run/force", layout)
    with h5py.File(folder / "link.h5", "w") as file:
        file["run/time"] = times
        file["run/force"] = h5py.ExternalLink(str(folder / "other.h5"), "/force")
    return ["external.h5", "pipe.h5", "virtual.h5", "endless.h5", "link.h5"]


def check_refused(file, *options):
    began = time.monotonic()
    done = run("fit", file, "--speed", "0.01", *options)
    text = done.stdout + done.stderr
    assert done.returncode == 3 and done.stderr.count("\n") == 1, f"{file.name}: exit {done.returncode}: {text}"
    assert "'/run/force' are in another file" in done.stderr, f"{file.name}: {text}"
    assert str(SECRET) not in text, f"{file.name}: numbers of another file: {text}"
    assert time.monotonic() - began < 5, f"{file.name}: {time.monotonic() - began:.1f} s"
    code = run("fit", file, "--speed", "0.01", "--json", *options)
    assert str(SECRET) not in code.stdout + code.stderr


def check_files(folder):
    for name in make_files(folder):
        check_refused(folder / name)
        check_refused(folder / name, "--variable", "run")
        check_refused(folder / name, "--variable", "/run/force")
        own = run("info", folder / name, "--variable", "run/time", "--json", "--sample-rate", "1000")
        assert own.returncode == 0 and '"rows": 500' in own.stdout, f"{name}: what the file itself holds: {own.stdout}{own.stderr}"


def long_image(file):
    rows, columns = 300, 300
    import struct
    import zlib
    chunk = lambda kind, content: struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
    pixels = b"".join(b"\0" + os.urandom(columns) for _ in range(rows))
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b""))


def check_rights(helper, *arguments):
    """The output does not fit into a pipe that nobody reads: the program waits with its file read."""
    program = SLIPFIT.with_name(helper)
    if not program.exists():
        return
    with subprocess.Popen([program, *arguments], stdout=subprocess.PIPE) as process:
        try:
            assert process.stdout.read(1) == b"=", f"{helper}: does not read its file"
            limits = pathlib.Path(f"/proc/{process.pid}/limits").read_text()
            files = next(line for line in limits.splitlines() if line.startswith("Max open files"))
            assert files.split()[3:5] == ["0", "0"], f"{helper}: {files}"
        finally:
            process.kill()


def check_helpers(folder):
    import h5py
    import numpy
    with h5py.File(folder / "long.h5", "w") as file:
        file["table"] = numpy.random.default_rng(1).random((200000, 2))
    check_rights("slipfit-hdf5", "hdf5", folder / "long.h5")
    long_image(folder / "long.png")
    check_rights("slipfit-image", folder / "long.png")


def with_modules():
    """Debian's own Python has the modules; the first may be another one."""
    try:
        import h5py  # noqa: F401
    except ImportError:
        if sys.executable == "/usr/bin/python3" or not pathlib.Path("/usr/bin/python3").exists():
            sys.exit(77)
        os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])


def main():
    with_modules()
    with tempfile.TemporaryDirectory() as name:
        check_files(pathlib.Path(name))
        check_helpers(pathlib.Path(name))
    print("no other file is read")


main()
