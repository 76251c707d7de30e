#!/usr/bin/env python3
"""files.py SLIPFIT: one profile as text, SDF and X3P, written from the standards' descriptions, read to the same numbers to the last
digit; images of a pattern; damaged, lying and swollen files, refused in one line, soon and without much memory; and a track beside the
force that wore it, also in a manifest."""

import csv
import io
import json
import math
import pathlib
import random
import resource
import struct
import subprocess
import sys
import tempfile
import time
import zipfile
import zlib

SLIPFIT = str(pathlib.Path(sys.argv[1]).resolve())
MOST_MEMORY = 3 << 30
LONGEST_S = 30
PITCH_M = 0.5e-6
SPACING_M = 20e-6
HAS_IMAGES = (pathlib.Path(SLIPFIT).parent / "slipfit-image").exists()


def run(*arguments):
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    return subprocess.run([SLIPFIT, "surface", *map(str, arguments)], capture_output=True, text=True, timeout=LONGEST_S, preexec_fn=limit)


def document(file, *options):
    done = run(file, "--json", *options)
    assert done.returncode == 0, f"{file}: {done.stderr}"
    return json.loads(done.stdout)


def numbers(file, *options):
    """All but what is about the file itself."""
    found = document(file, *options)
    del found["profile"]["file"], found["assumed"]
    return found


def refused(file, part, *options):
    began = time.monotonic()
    done = run(file, "--json", *options)
    took = time.monotonic() - began
    assert done.returncode == 3, f"{file.name}: exit code {done.returncode}, {done.stdout[:80]} {done.stderr}"
    assert done.stdout == "" and done.stderr.count("\n") == 1, f"{file.name}: {done.stderr}"
    assert part in done.stderr, f"{file.name}: '{part}' expected, found {done.stderr}"
    assert took < 10, f"{file.name}: {took:.1f} s"


def profile(count=1200, seed=3):
    rng = random.Random(seed)
    return [1e-6 * ((i * PITCH_M / SPACING_M) % 1.0) + rng.gauss(0, 5e-8) for i in range(count)]


def sdf_header(columns, rows, z_scale, kind, pitch_m=PITCH_M):
    return b"bISO-1.0" + b"maker".ljust(10) + 2 * b"010120240000" + struct.pack("<HHddddBBB", columns, rows, pitch_m, pitch_m, z_scale,
                                                                                 -1.0, 0, kind, 0)


def sdf_text(heights, columns, rows, z_scale=1.0):
    head = f"aISO-1.0\nManufacID   = maker\nNumPoints   = {columns}\nNumProfiles = {rows}\nXscale      = {PITCH_M!r}\n" \
           f"Yscale      = {PITCH_M!r}\nZscale      = {z_scale!r}\nZresolution = -1\nCompression = 0\nDataType    = 7\nCheckType   = 0\n*\n"
    return head + "\n".join("BAD" if math.isnan(h) else repr(h / z_scale) for h in heights) + "\n*\n"


def x3p(data, columns, rows=1, kind="D", z_step=1.0, valid=None, x_axis=("I", PITCH_M), members=None, layers=1, increment=None):
    link = "<PointDataLink>bindata/data.bin</PointDataLink>" + ("<ValidPointsLink>bindata/valid.bin</ValidPointsLink>" if valid else "")
    xml = f"""<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2"><Record1><Revision>ISO5436 - 2000</Revision><FeatureType>PRF</FeatureType><Axes>
<CX><AxisType>{x_axis[0]}</AxisType><DataType>D</DataType>{f"<Increment>{x_axis[1]!r}</Increment>" if increment is None else increment}<Offset>0</Offset></CX>
<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>{PITCH_M!r}</Increment><Offset>0</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>{kind}</DataType><Increment>{z_step!r}</Increment><Offset>0</Offset></CZ></Axes></Record1>
<Record3><MatrixDimension><SizeX>{columns}</SizeX><SizeY>{rows}</SizeY><SizeZ>{layers}</SizeZ></MatrixDimension><DataLink>{link}</DataLink>
</Record3></p:ISO5436_2>"""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in (members or {"main.xml": xml, "bindata/data.bin": data, "bindata/valid.bin": valid or b""}).items():
            archive.writestr(name, content)
    return packed.getvalue()


def png(rows, bits=8):
    """Grey values, unfiltered."""
    def chunk(name, content):
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
    lines = b"".join(b"\0" + (bytes(row) if bits == 8 else struct.pack(f">{len(row)}H", *row)) for row in rows)
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), bits, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b"")


def tiff(rows):
    """One strip of eight bits a pixel."""
    tags = [(256, 4, len(rows[0])), (257, 4, len(rows)), (258, 3, 8), (259, 3, 1), (262, 3, 1), (273, 4, 8), (277, 3, 1),
            (278, 4, len(rows)), (279, 4, len(rows) * len(rows[0]))]
    pixels = b"".join(map(bytes, rows))
    entries = b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in tags)
    return b"II*\0" + struct.pack("<I", 8 + len(pixels)) + pixels + struct.pack("<H", len(tags)) + entries + b"\0\0\0\0"


def check_numbers(folder):
    heights = profile()
    n = len(heights)
    doubles = struct.pack(f"<{n}d", *heights)

    def same(name, content, reference, *options):
        file = folder / name
        file.write_bytes(content if isinstance(content, bytes) else content.encode("latin-1"))
        found = numbers(file, *options)
        assert found == reference, f"{name}: {found} is not {reference}"

    text = "Messung vom 1.1.2024\nGer\xe4t: A\n\nHoehe [m]\n" + "\n".join(map(repr, heights)).replace(".", ",") + "\n"
    first = folder / "first.txt"
    first.write_text(text, encoding="latin-1")
    reference = numbers(first, "--pitch", repr(PITCH_M))
    low, high = reference["spacing_m"]["ci95"]
    assert reference["status"] == "periodic" and low <= SPACING_M <= high, reference
    same("double.sdf", sdf_header(n, 1, 1.0, 7) + doubles, reference)
    same("text.sdf", sdf_text(heights, n, 1), reference)
    same("double.x3p", x3p(doubles, n), reference)
    counts = [round(h / 1e-10) for h in heights]
    whole = folder / "whole.sdf"
    whole.write_bytes(sdf_header(n, 1, 1e-10, 6) + struct.pack(f"<{n}i", *counts))
    whole_reference = numbers(whole)
    same("comma.x3p", x3p(doubles, n, increment="<Increment> 0,5e-6 </Increment>"), reference)
    same("whole.x3p", x3p(struct.pack(f"<{n}i", *counts), n, kind="L", z_step=1e-10), whole_reference)
    same("short.sdf", sdf_header(n, 1, 1e-9, 5) + struct.pack(f"<{n}h", *(round(h / 1e-9) for h in heights)),
         numbers_of(folder, "short.x3p", x3p(struct.pack(f"<{n}h", *(round(h / 1e-9) for h in heights)), n, kind="I", z_step=1e-9)))
#Holes : a word in text, a bit in X3P, the lowest integer in binary SDF.
    holed = [math.nan if i % 25 == 3 else h for i, h in enumerate(heights)]
    valid = bytes(sum((not math.isnan(holed[8 * k + b])) << b for b in range(8)) for k in range(n // 8))
    with_holes = numbers_of(folder, "holes.sdf", sdf_text(holed, n, 1))
    assert "holes_bridged" in [w["code"] for w in with_holes["warnings"]]
    same("holes.x3p", x3p(doubles, n, valid=valid), with_holes)
    lowest = [-2**31 if math.isnan(h) else round(h / 1e-10) for h in holed]
    assert "holes_bridged" in [w["code"] for w in numbers_of(folder, "holes_binary.sdf", sdf_header(n, 1, 1e-10, 6) +
                                                           struct.pack(f"<{n}i", *lowest))["warnings"]]
    places = struct.pack(f"<{2 * n}d", *(v for i, h in enumerate(heights) for v in (i * PITCH_M, h)))
    absolute = numbers_of(folder, "absolute.x3p", x3p(places, n, x_axis=("A", 1.0)))
    assert abs(absolute["spacing_m"]["value"] / reference["spacing_m"]["value"] - 1) < 1e-9


def numbers_of(folder, name, content, *options):
    file = folder / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return numbers(file, *options)


def check_images(folder):
    rng = random.Random(5)
    angle = math.radians(30)
    rows = [[min(255, max(0, int(128 + 60 * math.sin(2 * math.pi * (x * math.cos(angle) + y * math.sin(angle)) / 17) + rng.gauss(0, 20))))
             for x in range(260)] for y in range(200)]
    found = {}
    for name, content in {"track.png": png(rows), "track.tif": tiff(rows), "deep.png": png([[v * 200 for v in row] for row in rows], 16)}.items():
        file = folder / name
        file.write_bytes(content)
        refused(file, "--pixel")
        if not HAS_IMAGES:
            refused(file, "libleptonica-dev", "--pixel", "2um")
            continue
        found[name] = document(file, "--pixel", "2um")
        low, high = found[name]["spacing_m"]["ci95"]
        assert low <= 34e-6 <= high and high - low < 1e-6, found[name]
        assert abs(found[name]["profile"]["along_degrees"] - 30) < 0.5
        assert found[name]["ridge_height_m"]["value"] is None
# 31 degrees : the wrong direction smears the ridges, and the given one is taken.
        assert document(file, "--pixel", "2um", "--along", "31")["profile"]["along_degrees"] == 31
    if HAS_IMAGES:
        assert found["track.png"]["spacing_m"] == found["track.tif"]["spacing_m"]
        for name, content in {"cut.png": png(rows)[:900], "cut.tif": tiff(rows)[:900], "huge.png": huge_png(), "jpeg.jpg": b"\xff\xd8\xff\xe0junk"}.items():
            (folder / name).write_bytes(content)
            refused(folder / name, name, "--pixel", "2um")


def huge_png():
    content = bytearray(png([[1, 2], [3, 4]]))
    content[16:24] = struct.pack(">II", 2**31 - 1, 2**31 - 1)
    content[29:33] = struct.pack(">I", zlib.crc32(bytes(content[12:29])))
    return bytes(content)


def check_hostile(folder):
    n = 1200
    doubles = struct.pack(f"<{n}d", *profile(n))
    bomb = x3p(b"\0" * (300 << 20), 16, members=None)
    xml_bomb = x3p(b"", 0, members={"main.xml": b"<a>" + b" " * (400 << 20)})
    entities = '<!DOCTYPE l [<!ENTITY a "aaaaaaaaaa">' + "".join(f'<!ENTITY {chr(98 + i)} "{10 * f"&{chr(97 + i)};"}">' for i in range(9)) + "]><l>&j;</l>"
    files = {
        "cut.sdf": (sdf_header(n, 1, 1.0, 7) + doubles[:999], "ends before"),
        "cut_header.sdf": (sdf_header(n, 1, 1.0, 7)[:40], "cut off"),
        "lying.sdf": (sdf_header(65535, 65535, 1.0, 7) + doubles, "crop it to the track"),
        "no_pitch.sdf": (sdf_header(n, 1, 1.0, 7, 0.0) + doubles, "Xscale"),
        "nan_pitch.sdf": (sdf_header(n, 1, 1.0, 7, math.nan) + doubles, "Xscale"),
        "kind.sdf": (sdf_header(n, 1, 1.0, 99) + doubles, "data type"),
        "words.sdf": (b"aISO-1.0\nNumPoints = many\n*\n1 2 3\n", "numbers of points"),
        "cut.x3p": (x3p(doubles, n)[:700], "zip"),
        "short.x3p": (x3p(doubles[:800], n), "ends before"),
        "lying.x3p": (x3p(doubles, 2**40, 2**40), "crop it to the track"),
        "layers.x3p": (x3p(doubles, n, layers=7), "layers"),
        "no_increment.x3p": (x3p(doubles, n, increment=""), "no distance between points"),
        "empty_increment.x3p": (x3p(doubles, n, increment="<Increment/>"), "Increment of axis CX in its main.xml is ''"),
        "unit.x3p": (x3p(doubles, n, increment="<Increment>0.5 um</Increment>"), "Increment of axis CX in its main.xml is '0.5 um'"),
        "word.x3p": (x3p(doubles, n, increment="<Increment>fine</Increment>"), "is 'fine', expected a number of metres"),
        "type.x3p": (x3p(doubles, n, kind="Q"), "expected I, L, F or D"),
        "grouped.x3p": (x3p(doubles, "1,200"), "number of points"),
        "long.x3p": (x3p(b"", 5 << 20), "4 million in one line"),
        "long.csv": (b"z [um]\n" + b"1\n2\n" * (3 << 20), "4 million in one line", "--pitch", "1um"),
        "none.x3p": (x3p(doubles, 0), "number of points"),
        "bomb.x3p": (bomb, "bomb.x3p"),
        "xml_bomb.x3p": (xml_bomb, "xml_bomb.x3p"),
        "stated.x3p": (with_stated_size(x3p(b"", 0, members={"main.xml": b"<a>" + b" " * (100 << 20), "padding": noise(1 << 16)})), "decompresses to far more"),
        "nodes.x3p": (with_stated_size(x3p(b"", 0, members={"main.xml": b"<a>" + b"<a/>" * (20 << 20) + b"</a>", "padding": noise(1 << 20)})),
                      "decompresses to far more"),
        "entities.x3p": (x3p(b"", 0, members={"main.xml": entities}), "entities.x3p"),
        "no_xml.x3p": (x3p(b"", 0, members={"main.xml": "plain words"}), "XML"),
        "no_main.x3p": (x3p(b"", 0, members={"other.txt": "1,2"}), "main.xml"),
        "no_part.x3p": (x3p(b"", 0, members={"main.xml": x3p_xml(n)}), "does not contain"),
        "empty.csv": (b"", "empty"),
        "words.csv": (b"a letter to somebody\nof two lines\n", "no rows of numbers"),
    }
    for name, (content, part, *options) in files.items():
        (folder / name).write_bytes(content)
        refused(folder / name, part, *options)


def noise(count):
    return random.Random(1).randbytes(count)


def with_stated_size(archive, size=0x7FFFFFF0):
    """The archive states this packed size for each member, in its directory and before the member."""
    content = bytearray(archive)
    for signature, field in ((b"PK\x01\x02", 20), (b"PK\x03\x04", 18)):
        at = content.find(signature)
        while at >= 0:
            content[at + field:at + field + 4] = struct.pack("<I", size)
            at = content.find(signature, at + 4)
    return bytes(content)


def x3p_xml(n):
    with zipfile.ZipFile(io.BytesIO(x3p(b"", n))) as archive:
        return archive.read("main.xml")


def program(*arguments):
    return subprocess.run([SLIPFIT, *map(str, arguments)], capture_output=True, text=True, timeout=120, check=False)


def track(spacing_m, folder, name):
    rng = random.Random(9)
    pitch_m = spacing_m / 40
    rows = "".join(f"{i * pitch_m * 1e3:.9g},{((i / 40) % 1) + rng.gauss(0, 0.03):.5f}\n" for i in range(2000))
    (folder / name).write_text("x [mm],z [um]\n" + rows)
    return folder / name


def check_beside_the_force(folder):
    """The pattern of the slips, of every second slip, and none; the same in a manifest."""
    force = folder / "force.csv"
    made = program("simulate", "--stiffness", "5000", "--natural-frequency", "900", "--damping-ratio", "0.05", "--static-friction", "4",
                   "--kinetic-friction", "3", "--sample-rate", "10000", "--duration", "2", "--noise", "0.01", "--jitter", "0.02", "--speed", "0.01",
                   "--seed", "3", "--out", force)
    assert made.returncode == 0, made.stderr

    def derived(*options):
        done = program("fit", force, "--speed", "0.01", "--json", *options)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)["derived"]

    plain = derived()
    assert "surface_En" not in plain
    spacing_m = plain["pattern_spacing_m"]["value"]
    same = derived("--surface", track(spacing_m, folder, "same.csv"), "--report", folder / "page.html")
    assert abs(same["surface_En"]["value"]) <= 1 and same["surface_verdict"].startswith("agrees"), same
    low, high = same["surface_ratio"]["ci95"]
    assert low < 1 < high
    assert {k: v for k, v in same.items() if not k.startswith("surface")} == plain, "the surface changes nothing of the fit"
    page = (folder / "page.html").read_text()
    assert "measured profile of the worn track" in page and "On the worn surface" in page
    twice = derived("--surface", track(2 * spacing_m, folder, "twice.csv"))
    assert twice["surface_En"]["value"] > 1 and "2 times as coarse" in twice["surface_verdict"], twice
    assert derived("--surface", track(1.4 * spacing_m, folder, "other.csv"))["surface_verdict"].startswith("no relation")
    gone = program("fit", force, "--speed", "0.01", "--surface", folder / "gone.x3p")
    assert gone.returncode == 3 and gone.stderr.count("\n") == 1
    (folder / "runs.csv").write_text("id,file,speed_m_per_s,surface,measured_spacing_um,measured_spacing_se_um\n"
                                     f"a,force.csv,0.01,same.csv,{1.2e6 * spacing_m},\nb,force.csv,0.01,,{1.2e6 * spacing_m},{1e6 * spacing_m}\n"
                                     "c,force.csv,0.01,gone.x3p,,\n")
    done = program("batch", folder / "runs.csv", "--out", folder / "batch", "--jobs", "1")
    assert done.returncode == 1, done.stderr
    a, b = (json.loads(line)["derived"] for line in (folder / "batch/results.jsonl").read_text().splitlines())
    assert a["surface_En"] == same["surface_En"]
    assert "counts as exact" in a["measured_spacing_En"]["note"] and "note" not in b["measured_spacing_En"]
    assert abs(a["measured_spacing_En"]["value"]) > 1 > abs(b["measured_spacing_En"]["value"])
    with open(folder / "batch/summary.csv", newline="", encoding="utf-8") as file:
        summary = {row["id"]: row for row in csv.DictReader(file)}
    worn = [a["surface_spacing_m"]["value"], *a["surface_spacing_m"]["ci95"], a["surface_En"]["value"]]
    assert [float(summary["a"][f"surface_{k}"]) for k in ("spacing_m", "spacing_low_m", "spacing_high_m", "En")] == worn
    assert summary["a"]["surface_verdict"] == a["surface_verdict"] and summary["b"]["surface_verdict"] == summary["c"]["surface_En"] == ""
    assert "c,file_not_found" in (folder / "batch/failures.csv").read_text()


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_numbers(folder)
        check_images(folder)
        check_hostile(folder)
        check_beside_the_force(folder)


main()
