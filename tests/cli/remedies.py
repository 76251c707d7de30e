#!/usr/bin/env python3
"""remedies.py SLIPFIT [--update]: causes the errors of docs/formats.md#errors, and tries the remedy that each message states.

A case is a command that is refused, words that its message must contain, and the same command with the remedy, which must
succeed. docs/errors.md lists code, message and remedy of each; --update writes it anew."""
import gzip
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import zipfile
import zlib

SLIPFIT = str(pathlib.Path(sys.argv[1]).resolve())
PROJECT = pathlib.Path(__file__).resolve().parents[2]
PAGE = PROJECT / "docs" / "errors.md"
HEAD = """# Error messages

Messages as `slipfit` prints them, and for each a command that succeeds: the one that was refused with the remedy that the message
states. A test causes every message and tries every remedy; [formats.md](formats.md#errors) lists all codes with causes and exit codes.

| code | message | with the remedy: `slipfit ...` |
|---|---|---|
"""
V = ["--speed", "10mm/s"]
ANALYZE = ["analyze", "ok.csv", *V]


def saw(i):
    return 2.0 + 0.025 * (i % 40) if i % 40 < 36 else 2.9 - 0.225 * (i % 40 - 36)


def table(head, line, count=400):
    return "\n".join([head, *(line(i) for i in range(count))]) + "\n"


def strokes(i):
    side = 1 if (i // 200) % 2 == 0 else -1
    return side * min(1.0, (i % 200) / 10.0) * saw(i)


def profile(i):
    return 1.0 + abs(i % 20 - 10) / 10.0


def png():
    """A grey image of ridges every 20 pixels."""
    rows = b"".join(b"\0" + bytes(int(100 * profile(x)) for x in range(800)) for _ in range(8))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 800, 8, 8, 0, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def write_files(folder):
    plain = table("time [s],force [N]", lambda i: f"{0.01 * i:.2f},{saw(i):.4f}")
    texts = {
        "ok.csv": plain,
        "empty.csv": "",
        "words.csv": "no numbers\nat all\n",
        "comma.csv": table("time,force", lambda i: f"{i // 100},{i % 100:02d},{saw(i):.3f}".replace(".", ",")),
        "before.csv": "time [s],force [N]\n" + "0.00,1.2.3\n" * 5 + table("", lambda i: f"{0.01 * i:.2f},{saw(i):.4f}").lstrip(),
        "line.csv": "word," * 1_000_000,
        "force.csv": table("force [N]", lambda i: f"{saw(i):.4f}"),
        "times.csv": table("time a [s],time b [s],force [N]", lambda i: f"{0.01 * i:.2f},{0.01 * i + 1:.2f},{saw(i):.4f}"),
        "temperature.csv": table("time [s],temperature [K]", lambda i: f"{0.01 * i:.2f},{saw(i):.4f}"),
        "two.csv": table("time [s],Fx [N],Fy [N]", lambda i: f"{0.01 * i:.2f},{saw(i):.4f},{saw(i + 7):.4f}"),
        "text.csv": table("time [s],force [N],state", lambda i: f"{0.01 * i:.2f},{saw(i):.4f},on"),
        "volt.csv": table("time [s],force [V]", lambda i: f"{0.01 * i:.2f},{saw(i):.4f}"),
        "torque.csv": table("time [s],torque [N m]", lambda i: f"{0.01 * i:.2f},{saw(i):.4f}"),
        "moves.csv": table("time [s],force [N],displacement [mm]", lambda i: f"{0.01 * i:.2f},{saw(i):.4f},{0.1 * i:.2f}"),
        "speeds.csv": table("time [s],force [N],speed [mm/s]", lambda i: f"{0.01 * i:.2f},{saw(i):.4f},{1 + 0.02 * i:.2f}"),
        "brackets.csv": table("time [s],force [N],spare [N]", lambda i: f"{0.01 * i:.2f},{f'({saw(i):.3f})' if i % 5 == 3 else f'{saw(i):.3f}'},{saw(i):.4f}"),
        "missing.csv": table("time [s],force [N],spare [N]", lambda i: f"{0.01 * i:.2f},nan,{saw(i):.4f}"),
        "short.csv": "time [s],force [N]\n0,1\n",
        "ten.csv": table("time [s],force [N]", lambda i: f"{0.01 * i:.2f},{saw(i):.4f}", 10),
        "constant.csv": table("time [s],force [N],other [N]", lambda i: f"{0.01 * i:.2f},1,{saw(i):.4f}"),
        "backwards.csv": table("time [s],clock [s],force [N]", lambda i: f"{0.5 + 0.01 * ((i * 7) % 40):.2f},{0.01 * i:.2f},{saw(i):.4f}"),
        "stands.csv": table("time [s],clock [s],force [N]", lambda i: f"1,{0.01 * i:.2f},{saw(i):.4f}"),
        "coarse.csv": table("time [s],force [N]", lambda i: f"{i // 50},{saw(i):.4f}"),
        "strokes.csv": table("time [s],force [N]", lambda i: f"{0.01 * i:.2f},{strokes(i):.4f}", 1600),
        "cof.csv": table("time [s],COF", lambda i: f"{0.01 * i:.2f},{saw(i):.4f}"),
        "steps.csv": "step,time [s],force [N]\n" + "".join(f"{s},{0.01 * i:.2f},{saw(i):.4f}\n" for s in (1, 2) for i in range(200)),
        "heights.csv": table("height [um]", lambda i: f"{profile(i):.4f}", 800),
        "nounit.csv": table("x,z", lambda i: f"{10 * i},{profile(i):.4f}", 800),
        "profile.csv": table("x [um],z [um]", lambda i: f"{10 * i},{profile(i):.4f}", 800),
        "shorttrack.csv": table("x [um],z [um]", lambda i: f"{10 * i},{profile(i):.4f}", 30),
        "fewridges.csv": table("x [um],z [um]", lambda i: f"{10 * i},{profile(i):.4f}", 70),
        "flat.csv": table("x [um],z [um],y [um]", lambda i: f"{10 * i},1,{profile(i):.4f}", 800),
        "holes.csv": table("x [um],z [um]", lambda i: f"{10 * i},{'' if i % 4 == 0 else f'{profile(i):.4f}'}", 800),
        "turns.csv": table("x [um],y [um],z [um]", lambda i: f"{10 * ((i * 7) % 50)},{10 * i},{profile(i):.4f}", 800),
        "page.txt": "not a page",
    }
    for name, text in texts.items():
        (folder / name).write_text(text)
    (folder / "binary.csv").write_bytes(bytes(range(32)) * 100)
    packed = gzip.compress(plain.encode())
    (folder / "whole.csv.gz").write_bytes(packed)
    (folder / "cut.csv.gz").write_bytes(packed[: len(packed) // 2])
    (folder / "old.xls").write_bytes(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(5000))
    with zipfile.ZipFile(folder / "two.zip", "w") as archive:
        archive.writestr("a.csv", plain)
        archive.writestr("b.csv", plain)
    (folder / "image.png").write_bytes(png())
    for name, lines in {
        "m.csv": ["ok,ok.csv,0.01"], "empty_m.csv": [], "fields.csv": ["ok,ok.csv"], "quote.csv": ['ok,"ok.csv,0.01'],
        "noid.csv": [",ok.csv,0.01"], "slash.csv": ["a/b,ok.csv,0.01"], "twice.csv": ["ok,ok.csv,0.01", "ok,ok.csv,0.01"],
        "number.csv": ["ok,ok.csv,fast"], "zero.csv": ["ok,ok.csv,0"],
    }.items():
        (folder / name).write_text("\n".join(["id,file,speed_m_per_s", *lines]) + "\n")
    for name, column, cell in [("step", "step", "x"), ("where", "where", "x"), ("stroke", "strokes", "x"), ("segment", "segments", "x"),
                               ("view", "force_view", "x"), ("drift", "drift", "x"), ("filter", "sensor_filter", "4"), ("group", "group", "steel")]:
        (folder / f"m_{name}.csv").write_text(f"id,file,speed_m_per_s,{column}\nok,ok.csv,0.01,{cell}\n")
    (folder / "m_pieces.csv").write_text("id,file,speed_m_per_s,strokes,segments\nok,ok.csv,0.01,both,yes\n")
    (folder / "m_double.csv").write_text("id,file,speed_m_per_s,speed [mm/s]\nok,ok.csv,0.01,10\n")
    (folder / "m_nospeed.csv").write_text("id,file\nok,ok.csv\n")
    (folder / "contact.csv").write_text("id,file,speed_m_per_s,force_view\na,demo.csv,0.01,contact\nb,demo2.csv,0.01,contact\n")
    (folder / "cofs.csv").write_text("id,file,speed_m_per_s\na,cof.csv,0.01\nb,cof.csv,0.02\n")
    (folder / "cofs_load.csv").write_text("id,file,speed_m_per_s,normal_force_N\na,cof.csv,0.01,2\nb,cof.csv,0.02,2\n")
    (folder / "pair.csv").write_text("id,file,speed_m_per_s\na,demo.csv,0.01\nb,demo2.csv,0.01\n")
    (folder / "bad.json").write_text("{}")
    (folder / "summary.csv").write_text("id,file,speed_m_per_s\nok,ok.csv,0.01\n")
    model = ["--stiffness", "5000", "--natural-frequency", "900", "--damping-ratio", "0.05", "--static-friction", "4", "--kinetic-friction", "3"]
    for seed, name in ((1, "demo"), (2, "demo2")):
        run(folder, ["simulate", *model, *V, "--duration", "1", "--sample-rate", "5000", "--noise", "0.01", "--jitter", "0.03", "--seed", str(seed), "--out", f"{name}.csv"])
    run(folder, ["simulate", *model, "--speed", "500mm/s", "--duration", "1", "--sample-rate", "5000", "--noise", "0.01", "--seed", "3", "--out", "steady.csv"])
    run(folder, ["fit", "demo.csv", *V, "--json", "--out", "fit.json"])
    (folder / "nocov.json").write_text(json.dumps({**json.loads((folder / "fit.json").read_text()), "correlation": None}))
    run(folder, ["fit", "demo.csv", *V, "--normal-force", "10N", "--json", "--out", "load.json"])
    run(folder, ["fit", "steady.csv", "--speed", "500mm/s", "--json", "--out", "steady.json"])
    run(folder, ["batch", "m.csv", "--out", "done"])
    run(folder, ["batch", "pair.csv", "--out", "first", "--shard", "1/2"])
    run(folder, ["batch", "pair.csv", "--out", "second", "--shard", "2/2"])


def of_file(name, *remedy):
    """The refused command, and the one with the remedy: options, or another file in place of the first."""
    command = ["analyze", name, *V]
    return command, [*command, *remedy]


FIT = ["fit", "ok.csv", *V]
S = ["simulate", "--stiffness", "5000", "--natural-frequency", "900", "--static-friction", "4", "--kinetic-friction", "3", *V, "--duration", "1", "--sample-rate", "5000", "--out", "s.csv"]
B = lambda manifest, *more: ["batch", manifest, "--out", "new", *more]
TO_M = B("m.csv", "--resume")
CASES = [  # codes, words of the message, refused command, command with the remedy
    ("file_not_found", "ok.cvs", ["analyze", "ok.cvs", *V], ANALYZE),
    ("is_directory", "is a (folder|directory)", ["analyze", ".", *V], ANALYZE),
    ("empty_file", "export", ["analyze", "empty.csv", *V], ANALYZE),
    ("binary_file", "export", ["analyze", "binary.csv", *V], ANALYZE),
    ("damaged_container", "copy|export", ["analyze", "cut.csv.gz", *V], ["analyze", "whole.csv.gz", *V]),
    ("unknown_sheet", "--sheet", *of_file("two.zip", "--sheet", "a.csv")),
    ("no_container", "leave", [*ANALYZE, "--sheet", "1"], ANALYZE),
    ("comma_twice", "semicolons", ["analyze", "comma.csv", *V], ANALYZE),
    ("old_workbook", "xlsx", ["analyze", "old.xls", *V], ANALYZE),
    ("no_numeric_column", "recording is", ["analyze", "words.csv", *V], ANALYZE),
    ("rows_before_data", "correct or delete", ["analyze", "before.csv", *V], ANALYZE),
    ("line_too_long", "expected", ["analyze", "line.csv", *V], ANALYZE),
    ("no_time_column", "--sample-rate", *of_file("force.csv", "--sample-rate", "100")),
    ("ambiguous_time_column", "--time-column", *of_file("times.csv", "--time-column", "time a")),
    ("no_force_column", "--force-column", *of_file("temperature.csv", "--force-column", "2", "--force-unit", "N")),
    ("ambiguous_force_column", "--force-column", *of_file("two.csv", "--force-column", "Fx")),
    ("unknown_column", "the columns are", [*ANALYZE, "--force-column", "Fx"], [*ANALYZE, "--force-column", "force"]),
    ("column_not_numeric", "choose another", ["analyze", "text.csv", *V, "--force-column", "state"], ["analyze", "text.csv", *V]),
    ("unknown_unit", "--force-scale", *of_file("volt.csv", "--force-scale", "5 N/V")),
    ("no_radius", "--radius", *of_file("torque.csv", "--radius", "12mm")),
    ("conflicting_options", "leave out one", [*ANALYZE, "--time-column", "1", "--sample-rate", "100"], [*ANALYZE, "--time-column", "1"]),
    ("bad_window", "T0", [*ANALYZE, "--window", "3:1"], [*ANALYZE, "--window", "1:3"]),
    ("bad_rows", "A:B", [*ANALYZE, "--rows", "30:10"], [*ANALYZE, "--rows", "10:300"]),
    ("unknown_step", "--step", ["analyze", "steps.csv", *V, "--step", "7"], ["analyze", "steps.csv", *V, "--step", "2"]),
    ("part_empty", "--rows", [*ANALYZE, "--rows", "900:999"], [*ANALYZE, "--rows", "1:300"]),
    ("no_speed", "--speed", ["fit", "ok.csv"], ["fit", "ok.csv", *V]),
    ("speed_contradicted", "--speed 600mm/min", ["analyze", "moves.csv", "--speed", "600mm/s"], ["analyze", "moves.csv", "--speed", "600mm/min"]),
    ("speed_varies", "--speed", ["fit", "speeds.csv"], ["fit", "speeds.csv", *V]),
    ("bad_sample_rate", "above|positive", ["analyze", "force.csv", *V, "--sample-rate", "0"], ["analyze", "force.csv", *V, "--sample-rate", "100"]),
    ("window_empty", "clock runs from", [*ANALYZE, "--window", "50:60"], [*ANALYZE, "--window", "0:3"]),
    ("unread_numbers", "another column with --force-column", *of_file("brackets.csv", "--force-column", "spare")),
    ("no_number_in_column", "--force-column", *of_file("missing.csv", "--force-column", "spare")),
    ("too_few_samples", "at least", ["analyze", "short.csv", *V], ANALYZE),
    ("too_few_samples", "16", ["analyze", "ten.csv", *V], ANALYZE),
    ("force_constant", "--force-column", *of_file("constant.csv", "--force-column", "other")),
    ("time_runs_backwards", "--time-column", ["analyze", "backwards.csv", *V, "--time-column", "time"], ["analyze", "backwards.csv", *V, "--time-column", "clock"]),
    ("time_constant", "--time-column", ["analyze", "stands.csv", *V, "--time-column", "time"], ["analyze", "stands.csv", *V, "--time-column", "clock"]),
    ("time_too_coarse", "--sample-rate 50", *of_file("coarse.csv", "--sample-rate", "50")),
    ("no_strokes", "leave out --strokes", [*ANALYZE, "--strokes"], ANALYZE),
    ("no_segments", "leave out --segments", [*ANALYZE, "--segments"], ANALYZE),
    ("not_a_force", "normal_force_N", ["fit", "--joint", "cofs.csv"], ["fit", "--joint", "cofs_load.csv"]),
    ("view_not_spring", "separately", ["fit", "--joint", "contact.csv"], ["fit", "demo.csv", *V, "--force-view", "contact"]),
    ("no_unit", "--unit", ["surface", "nounit.csv"], ["surface", "nounit.csv", "--unit", "um"]),
    ("no_pitch", "--pitch", ["surface", "heights.csv"], ["surface", "heights.csv", "--pitch", "10um"]),
    ("no_pixel", "--pixel", ["surface", "image.png"], ["surface", "image.png", "--pixel", "10um"]),
    ("ambiguous_columns", "--z-column", ["surface", "two.csv"], ["surface", "profile.csv", "--z-column", "z"]),
    ("places_not_rising", "column", ["surface", "turns.csv", "--x-column", "x", "--z-column", "z"], ["surface", "turns.csv", "--x-column", "y", "--z-column", "z"]),
    ("not_a_surface", "give X3P", ["surface", "two.zip"], ["surface", "profile.csv"]),
    ("too_few_points", "longer", ["surface", "shorttrack.csv"], ["surface", "profile.csv"]),
    ("too_few_ridges", "longer", ["surface", "fewridges.csv"], ["surface", "profile.csv"]),
    ("constant_profile", "column", ["surface", "flat.csv", "--x-column", "x", "--z-column", "z"], ["surface", "flat.csv", "--x-column", "x", "--z-column", "y"]),
    ("too_many_holes", "measure", ["surface", "holes.csv"], ["surface", "profile.csv"]),
    ("empty_manifest", "recording", ["fit", "--joint", "empty_m.csv"], ["fit", "--joint", "pair.csv"]),
    ("missing_column", "speed", B("m_nospeed.csv"), TO_M),
    ("duplicate_column", "expected one", B("m_double.csv"), TO_M),
    ("wrong_field_count", "expected", B("fields.csv"), TO_M),
    ("open_quote", "quote", B("quote.csv"), TO_M),
    ("missing_value", "id", B("noid.csv"), TO_M),
    ("bad_id", "expected", B("slash.csv"), TO_M),
    ("duplicate_id", "different", B("twice.csv"), TO_M),
    ("bad_number", "expected", B("number.csv"), TO_M),
    ("out_of_range", "expected|above", B("zero.csv"), TO_M),
    ("bad_step", "expected", B("m_step.csv"), TO_M),
    ("bad_where", "COLUMN=VALUE", B("m_where.csv"), TO_M),
    ("bad_strokes", "positive", B("m_stroke.csv"), TO_M),
    ("bad_segments", "yes or no", B("m_segment.csv"), TO_M),
    ("conflicting_pieces", "either", B("m_pieces.csv"), TO_M),
    ("unknown_force_view", "spring", B("m_view.csv"), TO_M),
    ("unknown_drift", "sensor, friction or none", B("m_drift.csv"), TO_M),
    ("bad_sensor_filter", "200 Hz", B("m_filter.csv"), TO_M),
    ("conflicting_sensor", "either", ["fit", "demo.csv", "--speed", "10mm/s", "--sensor-bandwidth", "1kHz", "--sensor-filter", "2, 1kHz"],
     ["fit", "demo.csv", "--speed", "10mm/s", "--sensor-bandwidth", "1kHz"]),
    ("unknown_group", "steel", ["fit", "--joint", "m_group.csv", "--group", "brass"], ["fit", "--joint", "pair.csv"]),
    ("cannot_write", "cannot", ["batch", "m.csv", "--out", "page.txt/x"], ["batch", "m.csv", "--out", "other"]),
    ("folder_of_another_batch", "--out", ["batch", "pair.csv", "--out", "done", "--resume"], ["batch", "pair.csv", "--out", "done2"]),
    ("results_present", "--resume", ["batch", "m.csv", "--out", "done"], ["batch", "m.csv", "--out", "done", "--resume"]),
    ("not_a_page", "page", ["batch", "m.csv", "--out", "third", "--report", "page.txt"], ["batch", "m.csv", "--out", "third", "--report", "third/index.html"]),
    ("bad_document", "fit --json", ["predict", "bad.json", "--speeds", "1mm/s"], ["predict", "fit.json", "--speeds", "1mm/s"]),
    ("not_a_batch", "run.json", ["merge", ".", "--out", "all"], ["merge", "first", "second", "--out", "all"]),
    ("shards_missing", "missing|all", ["merge", "first", "--out", "all2"], ["merge", "first", "second", "--out", "all2"]),
    ("shards_differ", "", ["merge", "first", "first", "--out", "all3"], ["merge", "first", "second", "--out", "all3"]),
    ("parameter_out_of_range", "", [*S, "--damping-ratio", "-1"], [*S, "--damping-ratio", "0.1"]),
    ("cannot_predict", "stick-slip|needs", ["predict", "steady.json", "--speeds", "1mm/s"], ["predict", "fit.json", "--speeds", "1mm/s"]),
    ("no_normal_force", "--normal-force", ["predict", "fit.json", "--speeds", "1mm/s", "--normal-force", "5N"], ["predict", "load.json", "--speeds", "1mm/s", "--normal-force", "5N"]),
    ("bad_speeds", "number", ["predict", "fit.json", "--speeds", "fast"], ["predict", "fit.json", "--speeds", "1mm/s:10mm/s:3"]),
    ("unknown_tier", "damped", ["fit", "demo.csv", *V, "--tier", "best"], ["fit", "demo.csv", *V, "--tier", "damped"]),
    ("unknown_fix", "damping_ratio", ["fit", "demo.csv", *V, "--fix", "zet=0.1"], ["fit", "demo.csv", *V, "--fix", "damping_ratio=0.05"]),
    ("bad_target", "", ["plan", "fit.json", "--for", "colour"], ["plan", "fit.json", "--for", "stiffness_N_per_m"]),
    ("no_covariance", "fit --json", ["plan", "nocov.json"], ["plan", "fit.json"]),
    ("output_is_input", "another|other", ["batch", "summary.csv", "--out", "."], ["batch", "summary.csv", "--out", "elsewhere"]),
    ("wrong_usage", "'fit'", ["fti", "ok.csv", *V], FIT),
    ("wrong_usage", "'--speed'", ["fit", "ok.csv", "--sped", "10mm/s"], FIT),
    ("wrong_usage", "name a recording", ["fit"], FIT),
    ("wrong_usage", "one of analyze", [], FIT),
    ("wrong_usage", "give it once", [*FIT, *V], FIT),
    ("wrong_usage", "a.html", [*FIT, "--report", "a.pdf"], [*FIT, "--report", "a.html"]),
    ("wrong_usage", "another file", [*FIT, "--out", "ok.csv"], [*FIT, "--out", "fit.txt"]),
    ("wrong_usage", "different files", [*FIT, "--out", "x.txt", "--cycles", "x.txt"], [*FIT, "--out", "x.txt", "--cycles", "x.csv"]),
    ("wrong_usage", "'absent' does not exist", [*FIT, "--out", "absent/fit.txt"], [*FIT, "--out", "fit.txt"]),
    ("wrong_usage", "one recording", ["fit", "ok.csv", "demo.csv", *V, "--cycles", "x.csv"], [*FIT, "--cycles", "x.csv"]),
    ("wrong_usage", "cannot be combined", ["fit", "strokes.csv", *V, "--strokes", "--cycles", "x.csv"], ["fit", "strokes.csv", *V, "--strokes"]),
    ("wrong_usage", "--joint", [*FIT, "--group", "a"], ["fit", "--joint", "pair.csv"]),
    ("wrong_usage", "other options come after", ["fit", "--joint", "--tier", "damped", "pair.csv"], ["fit", "--joint", "pair.csv", "--tier", "damped"]),
    ("wrong_usage", "above zero", ["fit", "ok.csv", "--speed", "0"], FIT),
    ("wrong_usage", "mm/s", ["fit", "ok.csv", "--speed", "10 parsec"], FIT),
    ("wrong_usage", "give F_s", [*S[:5], *S[7:]], S),
    ("wrong_usage", "either --mass", [*S, "--mass", "1"], S),
    ("wrong_usage", "not both", [*S, "--f0", "3", "--f1", "1", "--alpha", "-1"], S),
    ("wrong_usage", "--speeds 1mm/s", ["predict", "fit.json"], ["predict", "fit.json", "--speeds", "1mm/s:1m/s:5"]),
    ("wrong_usage", "give FIT.json", ["predict", "--speeds", "1mm/s"], ["predict", "fit.json", "--speeds", "1mm/s"]),
    ("wrong_usage", "either", ["predict", "fit.json", "--speeds", "1mm/s", "--stiffness", "5000"], ["predict", "fit.json", "--speeds", "1mm/s"]),
    ("wrong_usage", "--at", ["plan", "fit.json", "--for", "periodic_displacement_m"], ["plan", "fit.json", "--for", "periodic_displacement_m", "--at", "10mm/s"]),
    ("wrong_usage", "give A and B", ["compare", "fit.json"], ["compare", "fit.json", "load.json"]),
    ("wrong_usage", "I/N", B("m.csv", "--shard", "3/2"), TO_M),
    ("wrong_usage", "1 to", B("m.csv", "--jobs", "0"), B("m.csv", "--resume", "--jobs", "1")),
]


def run(folder, words):
    return subprocess.run([SLIPFIT, *words], cwd=folder, capture_output=True, text=True, check=False)


def main():
    faults, lines = [], []
    documented = (PROJECT / "docs" / "formats.md").read_text().split("\n## Errors\n")[1].split("\n## ")[0]
    known = {code: exits for row, exits in re.findall(r"\n\| (`[^|]*) \| ([^|]*) \|", documented) for code in re.findall(r"`(\w+)`", row)}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_files(folder)
        for code, words, refused, remedied in CASES:
            done = run(folder, refused)
            message = done.stderr.strip().split("\n")[-1] if done.stderr.strip() else ""
            after = run(folder, remedied)
            remedy = " ".join(f"'{word}'" if " " in word else word for word in remedied)
            lines.append(f"| `{code}` | {message.removeprefix('slipfit: ').replace('|', '&#124;')} | `{remedy}` |")
            exits = re.findall(r"\b[123]\b", known.get(code, "2"))
            if str(done.returncode) not in exits or done.stdout:
                faults.append(f"{code}: exit code {done.returncode}, expected {exits} and no output: {done.stdout[:200]}")
            if not re.search(words, message) or done.stderr != message + "\n" or not message.startswith("slipfit: "):
                faults.append(f"{code}: expected one line with '{words}': {done.stderr}")
            if after.returncode != 0:
                faults.append(f"{code}: the remedy fails: slipfit {' '.join(remedied)}: {after.stderr.strip()}")
            if code not in known and code != "wrong_usage":
                faults.append(f"{code}: not in docs/formats.md")
    table = HEAD + "".join(line + "\n" for line in lines)
    if "--update" in sys.argv:
        PAGE.write_text(table)
    elif PAGE.read_text() != table:
        faults.append(f"{PAGE}: is not what {sys.argv[0]} --update writes")
    print(*faults, sep="\n", file=sys.stderr)
    print(f"{len(CASES)} errors and remedies, {len(faults)} faults", file=sys.stderr)
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
