#!/usr/bin/env python3
"""containers.py SLIPFIT [FOLDER]: one recording as CSV and in every container, read to the same numbers to the last digit; and damaged, lying
and swollen containers, refused in one line, soon and without much memory. With FOLDER the containers are left there and nothing else is
done but to print them: a JSON list of [file, option...].

The containers are made by other people's programs: Python's gzip, zipfile, openpyxl, scipy, h5py, numpy. TDMS is written by hand from its
description. Exit 77 where a module is missing and nothing else failed."""

import gzip
import io
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import zipfile

SLIPFIT = str(pathlib.Path(sys.argv[1]).resolve())
MODEL = ["--stiffness", "5000", "--natural-frequency", "900", "--damping-ratio", "0.05", "--static-friction", "4", "--kinetic-friction", "3",
         "--sample-rate", "10000", "--duration", "0.5", "--noise", "0.01", "--speed", "0.01", "--seed", "3"]
MOST_MEMORY = 9 << 30
LONGEST_S = 120


def run(*arguments, most_memory=MOST_MEMORY, most_cpu_s=LONGEST_S):
    limits = ["prlimit", f"--as={most_memory}", f"--cpu={most_cpu_s}"]
    return subprocess.run([*limits, SLIPFIT, *map(str, arguments)], capture_output=True, text=True, timeout=LONGEST_S)


def numbers(file, *options):
    """The document of a fit, but for what is about the file itself."""
    done = run("fit", file, "--speed", "0.01", "--json", *options)
    assert done.returncode == 0, f"{file}: {done.stderr}"
    document = json.loads(done.stdout)
    del document["id"]
    for key in ("file", "input_digest", "input_bytes", "assumed", "options"):
        del document["recording"][key]
    return document


def tdms(names, columns, big_endian=False, interleaved=False, blocks=1):
    """One segment; the values in blocks."""
    order = ">" if big_endian else "<"
    count = len(columns[0]) // blocks
    text = lambda s: struct.pack(order + "I", len(s.encode())) + s.encode()
    meta = struct.pack(order + "I", len(names) + 1) + text("/") + struct.pack(order + "II", 0xFFFFFFFF, 0)
    for name, unit in names:
        meta += text(f"/'Run'/'{name}'") + struct.pack(order + "IIIQ", 20, 10, 1, count)
        meta += struct.pack(order + "I", 1) + text("unit_string") + struct.pack(order + "I", 0x20) + text(unit)
    raw = b""
    for b in range(blocks):
        part = [c[b * count:(b + 1) * count] for c in columns]
        flat = [v for row in zip(*part) for v in row] if interleaved else [v for c in part for v in c]
        raw += struct.pack(f"{order}{len(flat)}d", *flat)
    toc = 0x0E | (0x40 if big_endian else 0) | (0x20 if interleaved else 0)
    lead = b"TDSm" + struct.pack("<I", toc) + struct.pack(order + "IQQ", 4713, len(meta) + len(raw), len(meta))
    return lead + meta + raw


def zipped(name, content, **options):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, **options) as archive:
        archive.writestr(name, content)
    return file.getvalue()


def plain_containers(folder, text, times, forces):
    (folder / "run.csv.gz").write_bytes(gzip.compress(text))
    (folder / "two.csv.gz").write_bytes(gzip.compress(text[:5000]) + gzip.compress(text[5000:]))
    (folder / "renamed.csv").write_bytes(zipped("data/run.csv", text))
    names = [("Time", "s"), ("Force", "N")]
    for name, options in (("plain", {}), ("big", {"big_endian": True}), ("mixed", {"interleaved": True}), ("blocks", {"blocks": next(n for n in range(2, len(times)) if len(times) % n == 0)})):
        (folder / f"{name}.tdms").write_bytes(tdms(names, [times, forces], **options))
    return ["run.csv.gz", "two.csv.gz", "renamed.csv", "plain.tdms", "big.tdms", "mixed.tdms", "blocks.tdms"]


def workbooks(folder, times, forces):
    import openpyxl
    book = openpyxl.Workbook()
    book.active.title = "Parameters"
    book.active.append(["Operator", "A. B."])
    sheet = book.create_sheet("Specimen 1")
    for row in [("Test of 2024", None), ("Time", "Force"), ("s", "N"), *zip(times, forces)]:
        sheet.append(row)
    book.save(folder / "run.xlsx")
    return ["run.xlsx", ("run.xlsx", "--sheet", "Specimen 1"), ("run.xlsx", "--sheet", "2")]


def mat_by_hand(variables, order):
    """Of MATLAB 5, uncompressed: {name: (kind of the bytes, format of struct, values)}, each said to be of class double."""
    def element(kind, content):
        return struct.pack(order + "II", kind, len(content)) + content + bytes(-len(content) % 8)
    file = b"MATLAB 5.0 MAT-file, by hand".ljust(124) + struct.pack(order + "HH", 0x0100, 0x4D49)
    for name, (kind, letter, values) in variables.items():
        parts = [(6, struct.pack(order + "II", 6, 0)), (5, struct.pack(order + "ii", len(values), 1)), (1, name.encode()),
                 (kind, struct.pack(f"{order}{len(values)}{letter}", *values))]
        file += element(14, b"".join(element(*part) for part in parts))
    return file


def mat_files(folder, times, forces):
    import numpy
    import scipy.io
    (folder / "big.mat").write_bytes(mat_by_hand({"time_s": (9, "d", times), "force_N": (9, "d", forces)}, ">"))
    scipy.io.savemat(folder / "v5.mat", {"time_s": times, "force_N": forces, "gain": 2.0})
    scipy.io.savemat(folder / "v7.mat", {"run": {"time_s": times, "force_N": forces}}, do_compression=True)
    scipy.io.savemat(folder / "matrix.mat", {"data": numpy.column_stack([times, forces])})
    return ["big.mat", "v5.mat", "v7.mat", ("v7.mat", "--variable", "run"), ("matrix.mat", "--variable", "data")]


def hdf5_files(folder, times, forces):
    import h5py
    import numpy
    with h5py.File(folder / "group.h5", "w") as file:
        group = file.create_group("runs/first")
        for name, unit, values in (("time", "s", times), ("force", "N", forces)):
            group.create_dataset(name, data=values, compression="gzip").attrs["unit"] = unit
        file.create_dataset("scale", data=3.0)
    with h5py.File(folder / "table.h5", "w") as file:
        table = numpy.zeros(len(times), dtype=[("time", "f8"), ("force", "f8"), ("mark", "S4")])
        table["time"], table["force"] = times, forces
        file.create_dataset("table", data=table)
        file.create_dataset("array", data=numpy.column_stack([times, forces]))
    with h5py.File(folder / "v73.mat", "w", userblock_size=512) as file:
        for name, values in (("time_s", times), ("force_N", forces)):
            file.create_dataset(name, data=numpy.array([values])).attrs["MATLAB_class"] = numpy.bytes_("double")
    with open(folder / "v73.mat", "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + struct.pack("<HH", 0x0200, 0x4D49))
    return ["group.h5", ("group.h5", "--variable", "/runs/first"), "table.h5", ("table.h5", "--variable", "array"), "v73.mat"]


def numpy_files(folder, times, forces):
    import numpy
    both = numpy.column_stack([times, forces])
    fields = numpy.zeros(len(times), dtype=[("time_s", ">f8"), ("force_N", "f8"), ("mark", "u1")])
    fields["time_s"], fields["force_N"] = times, forces
    for name, array in (("rows", both), ("columns", numpy.asfortranarray(both)), ("big", both.astype(">f8")), ("fields", fields)):
        numpy.save(folder / f"{name}.npy", array)
    return ["rows.npy", "columns.npy", "big.npy", "fields.npy"]


def check_kinds(folder):
    """Numbers of each kind, as the reader beside slipfit prints them; MATLAB stores small doubles as small integers."""
    kinds = {1: "b", 2: "B", 3: "h", 4: "H", 5: "i", 6: "I", 7: "f", 9: "d", 12: "q", 13: "Q"}
    lowest = {letter: 0 if letter.isupper() else -100 for letter in kinds.values()}
    for order in "<>":
        variables = {f"kind_{kind}": (kind, letter, range(lowest[letter], 100)) for kind, letter in kinds.items()}
        (folder / "kinds.mat").write_bytes(mat_by_hand(variables, order))
        for name, (_, _, values) in variables.items():
            printed = subprocess.run([pathlib.Path(SLIPFIT).with_name("slipfit-hdf5"), "mat", folder / "kinds.mat", name],
                                     capture_output=True, text=True, timeout=LONGEST_S).stdout
            assert printed.splitlines() == [f"={name}", name, *map(str, values)], f"{name} of order {order}: {printed[:200]}"


def check_long_names(folder):
    """Names of variables are cut: one of a million letters does not fill every message."""
    times = [i / 1000 for i in range(50)]
    (folder / "names.mat").write_bytes(mat_by_hand({letter * 1000000: (9, "d", times) for letter in "ab"}, "<"))
    for arguments in (["info"], ["fit", "--speed", "0.01"], ["fit", "--speed", "0.01", "--variable", "c"]):
        done = run(arguments[0], folder / "names.mat", *arguments[1:])
        assert done.returncode in (0, 3) and len(done.stdout + done.stderr) < 10000, f"{len(done.stdout)}, {len(done.stderr)} letters"


def bombs(folder):
    """Small files that unpack to much, or say so."""
    zeros = b"time,force\n" + b"0,0\n" * (1 << 25)
    (folder / "bomb.csv.gz").write_bytes(gzip.compress(zeros))
    (folder / "bomb.zip").write_bytes(zipped("bomb.csv", zeros))
    cells = b"<row>" + b"<c><v>0</v></c>" * 20 + b"</row>"
    sheet = b"<worksheet><sheetData>" + cells * 400000 + b"</sheetData></worksheet>"
    (folder / "bomb.xlsx").write_bytes(workbook(sheet))
    huge = tdms([("a", "s"), ("b", "N")], [[0.0] * 4, [0.0] * 4])
    (folder / "lie.tdms").write_bytes(huge.replace(struct.pack("<IIIQ", 20, 10, 1, 4), struct.pack("<IIIQ", 20, 10, 1, 1 << 60)))
    (folder / "daqmx.tdms").write_bytes(huge.replace(struct.pack("<I", 0x0E), struct.pack("<I", 0x8E), 1))
    names = ["bomb.csv.gz", "bomb.zip", "bomb.xlsx", "lie.tdms", "daqmx.tdms"]
    try:
        import h5py
        with h5py.File(folder / "bomb.h5", "w") as file:
            file.create_dataset("x", shape=(1 << 33, 2), dtype="f8", chunks=(1 << 16, 2), compression="gzip")
        with h5py.File(folder / "chunk.h5", "w") as file:
            file.create_dataset("x", shape=(1 << 28, 2), dtype="f8", chunks=(1 << 27, 2), compression="gzip")
        names += ["bomb.h5", "chunk.h5"]
    except ImportError:
        pass
    return names


def workbook(sheet, book=None, links=None, strings=None):
    parts = {
        "xl/workbook.xml": book or b'<workbook xmlns:r="x"><sheets><sheet name="a" sheetId="1" r:id="r1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": links or b'<Relationships><Relationship Id="r1" Target="worksheets/sheet1.xml"/></Relationships>',
        "xl/worksheets/sheet1.xml": sheet,
        "xl/sharedStrings.xml": strings or b"<sst/>",
    }
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    return file.getvalue()


def with_stated_size(archive, size=0x7FFFFFF0):
    """The archive states this packed size for each member, in its directory and before the member."""
    content = bytearray(archive)
    for signature, field in ((b"PK\x01\x02", 20), (b"PK\x03\x04", 18)):
        at = content.find(signature)
        while at >= 0:
            content[at + field:at + field + 4] = struct.pack("<I", size)
            at = content.find(signature, at + 4)
    return bytes(content)


def padded(archive, count):
    """With a member of random bytes behind the others, so that the whole unpacks to no more than 200 times its size."""
    file = io.BytesIO(archive)
    with zipfile.ZipFile(file, "a", zipfile.ZIP_STORED) as more:
        more.writestr(".padding", os.urandom(count))
    return file.getvalue()


def check_limits(folder):
    """Sizes that an archive states, sheets, links, rows, nodes and repeated strings: refused by their limit, soon and without much memory."""
    cells = b"<row>" + b"<c><v>0</v></c>" * 20 + b"</row>"
    rows = lambda row, count: b"<worksheet><sheetData>" + row * count + b"</sheetData></worksheet>"
    far_more = "decompresses to far more"
    files = {
        "stated.zip": (with_stated_size(padded(zipped("a.csv", b"time,force\n" + b"0,0\n" * (1 << 25)), 1 << 16)), far_more),
        "stated.xlsx": (with_stated_size(padded(workbook(rows(cells, 500000)), 1 << 16)), far_more),
        "nodes.xlsx": (with_stated_size(padded(workbook(rows(cells, 500000)), 2 << 20)), far_more),
        "rows.xlsx": (padded(workbook(rows(b"<row><c><v>1</v></c></row>", (1 << 20) + 1)), 1 << 20), "more than 1048576 rows"),
        "sheets.xlsx": (workbook(rows(cells, 100), b'<workbook xmlns:r="x"><sheets>' + b'<s r:id="q"/>' * 400000 + b"</sheets></workbook>",
                                 b"<Relationships>" + b'<x Id="z"/>' * 400000 + b"</Relationships>"), "more than 4096 sheets"),
        "strings.xlsx": (workbook(rows(b"<row>" + b'<c t="s"><v>0</v></c>' * 16000 + b"</row>", 2), strings=b"<sst><si><t>" + b"a" * (1 << 22) +
                                  b"</t></si></sst>"), far_more),
    }
    for name, (content, words) in files.items():
        (folder / name).write_bytes(content)
        line = check_refused(folder / name, name, most_memory=3 << 30, most_cpu_s=20)
        assert words in line, f"{name}: {line}"
        (folder / name).unlink()


def damaged(folder, files):
    """Each cut off at several places, with other bytes in it, and with a wrong beginning."""
    for file in files:
        content = (folder / file).read_bytes()
        for share in (0.01, 0.1, 0.5, 0.9, 0.999):
            yield file, f"cut at {share}", content[:max(20, int(share * len(content)))]
        for place in range(30, len(content), max(1, len(content) // 12)):
            yield file, f"byte {place} turned", content[:place] + bytes([content[place] ^ 0xFF]) * 4 + content[place + 4:]
        yield file, "first bytes alone", content[:16]
        yield file, "zeros behind the first bytes", content[:16] + bytes(4096)


def check_refused(file, what, may_answer=False, **limits):
    done = run("fit", file, "--speed", "0.01", "--quiet", **limits)
    line = done.stderr.rstrip("\n")
    is_refusal = done.returncode == 3 and line.startswith("slipfit: ") and "\n" not in line and "internal" not in line
    assert is_refusal or (may_answer and done.returncode == 0), f"{what}: exit {done.returncode}: {done.stderr}"
    return line


def with_modules():
    """Debian's own Python has the modules; the first may be another one."""
    try:
        import h5py, openpyxl, scipy  # noqa: F401
    except ImportError:
        if sys.executable != "/usr/bin/python3" and pathlib.Path("/usr/bin/python3").exists():
            os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])


def make_containers(folder):
    """Writes the recording and its containers; returns those as file or (file, option...), and the modules that were missing."""
    rows = [line.split(",") for line in run("simulate", *MODEL).stdout.splitlines() if line[0].isdigit()]
    times, forces = [float(r[0]) for r in rows], [round(float(r[1]), 9) for r in rows]  # openpyxl writes 16 digits
    text = "".join(["time_s,force_N\n", *(f"{t!r},{f!r}\n" for t, f in zip(times, forces))])
    (folder / "run.csv").write_text(text)
    missing = []
    made = plain_containers(folder, text.encode(), times, forces)
    for make in (workbooks, mat_files, hdf5_files, numpy_files):
        try:
            made += make(folder, times, forces)
        except ImportError as error:
            missing.append(error.name)
    return made, missing


def leave_in(folder):
    made, _ = make_containers(folder)
    for file, what, content in damaged(folder, [entry for entry in made if isinstance(entry, str)]):
        name = f"{what.replace(' ', '-')}-{file}"
        (folder / name).write_bytes(content)
        made.append(name)
    print(json.dumps([[entry] if isinstance(entry, str) else entry for entry in made + bombs(folder)]))


def main():
    with_modules()
    if len(sys.argv) > 2:
        return leave_in(pathlib.Path(sys.argv[2]))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        made, missing = make_containers(folder)
        wanted = numbers(folder / "run.csv")
        for entry in made:
            file, *options = (entry,) if isinstance(entry, str) else entry
            found = numbers(folder / file, *options)
            assert found == wanted, f"{entry}: other numbers than the CSV's"
        check_kinds(folder)
        check_long_names(folder)
        check_limits(folder)
        for file in bombs(folder):
            print(check_refused(folder / file, file))
        once = dict.fromkeys(e for e in made if isinstance(e, str))
        for file, what, content in damaged(folder, once):
            (folder / ("hostile-" + file)).write_bytes(content)
            check_refused(folder / ("hostile-" + file), f"{file}, {what}", may_answer=True)
    print(f"{len(made)} ways to the same numbers" + (f"; missing: {', '.join(missing)}" if missing else ""))
    sys.exit(77 if missing else 0)


main()
