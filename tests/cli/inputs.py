#!/usr/bin/env python3
"""inputs.py SLIPFIT: files as testers export them, each with what slipfit makes of it, which docs/recordings.md lists as a table.
inputs.py --table prints that table."""
import gzip
import io
import pathlib
import struct
import subprocess
import sys
import tempfile
import zipfile

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "recordings.md"


def force(i):
    """N, a saw-tooth of 1 N to 2 N over 40 samples of 10 ms."""
    return 1.0 + (i % 40) / 36.0 if i % 40 < 36 else 2.0 - (i % 40 - 36) / 4.0


def rows(line, count=400, head="time [s],force [N]"):
    return "\n".join([head, *(line(i) for i in range(count))]) + "\n"


def clock(i):
    return f"12:00:{i // 100:02d},{10 * (i % 100):03d}"


def strokes(i):
    phase = (i // 200) % 2
    ramp = min(1.0, (i % 200) / 10.0 * 2.0 - 1.0) if i >= 200 else 1.0
    return (1 if phase == 0 else -1) * ramp * force(i)


def grouped(value):
    """1234.5 as 1.234,5"""
    return f"{value:,.1f}".translate(str.maketrans(",.", ".,"))


def tdms(cut):
    text = lambda s: struct.pack("<I", len(s)) + s.encode()
    meta = struct.pack("<I", 2)
    for name, unit in (("Time", "s"), ("Force", "N")):
        meta += text(f"/'Run'/'{name}'") + struct.pack("<IIIQ", 20, 10, 1, 100) + struct.pack("<I", 1)
        meta += text("unit_string") + struct.pack("<I", 0x20) + text(unit)
    raw = b"".join(struct.pack("<200d", *[0.01 * i for i in range(b, b + 100)], *[force(i) for i in range(b, b + 100)])
                   for b in range(0, 400, 100))
    lead = b"TDSm" + struct.pack("<IIQQ", 0x0E, 4713, len(meta) + len(raw), len(meta))
    whole = lead + meta + raw
    return whole[:len(whole) - cut]


def zipped(*names):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in names:
            archive.writestr(name, rows(lambda i: f"{i / 100},{force(i):.4f}"))
    return file.getvalue()


PLAIN = rows(lambda i: f"{i / 100},{force(i):.4f}")
UMT = rows(lambda i: f"{-100 * force(i):.3f},-200,0.1,0.01,0,{i / 100},{100 * force(i):.3f},{force(i) / 2:.4f},3",
           head="Created by CETR Data Viewer\nVelocity = 240\n\nFx,Fz,Z,V1,V2,T,Ff,COF,AE\ng,g,mm,mm/sec,mm/sec,sec,g,,dB")
STEPS = "Step,time [s],force [N],speed [mm/s]\n" + "".join(
    f"{step},{i / 100},{force(i):.4f},{speed}\n" for step, speed in ((1, 2), (2, 5)) for i in range(400))
SWEEP = rows(lambda i: f"{i / 100},{force(i):.4f},{(1, 2, 5)[i // 400]}", 1200, "time [s],force [N],speed [mm/s]")
V = ["--speed", "10mm/s"]

# title, content, options behind the file, exit code, what the answer or the message says
INPUTS = [
    ("CSV with names and units", PLAIN, V, 0, "Force is column 2 'force [N]', in N."),
    ("semicolons, decimal commas", rows(lambda i: f"{i / 100};{force(i):.4f}".replace(".", ","), head="Zeit [s];Kraft [N]"), V, 0, "The comma is the decimal sign."),
    ("a bar between the columns", rows(lambda i: f"{i / 100}|{force(i):.4f}", head="time [s]|force [N]"), V, 0, "Force is column 2 'force [N]', in N."),
    ("points between thousands, decimal commas", rows(lambda i: f"{grouped(1000 + i / 10)};{grouped(1000 * force(i))}", head="Zeit [s];Kraft [mN]"), V, 0, "The comma is the decimal sign."),
    ("comma between the columns and as decimal sign", rows(lambda i: f"{i / 100:.3f},{force(i):.3f}".replace(".", ","), head="time,force"), V, 3, "the comma is both the column separator and the decimal sign"),
    ("native export of a CETR/Bruker UMT", UMT, V, 0, "Force is column 7 'Ff', in g."),
    ("units that slipfit does not need (dB, lux, %RH)", rows(lambda i: f"{i / 100},{force(i):.4f},3,4,5", head="T,Ff,AE,light,hum\nsec,N,dB,lux,%RH"), V, 0, "Force is column 2 'Ff', in N."),
    ("time in ms", rows(lambda i: f"{10 * i},{force(i):.4f}", head="time [ms],force [mN]"), V, 0, "Time is column 1 'time [ms]', in ms."),
    ("time in ms without a unit", rows(lambda i: f"{10 * i},{force(i):.4f}", head="time,force [N]"), V, 0, "the file contains no unit of time: is the time in ms (--time-unit ms)?"),
    ("a name with 'in' before its unit", rows(lambda i: f"{i / 100};{force(i):.4f}", head="time, in s;force, in N"), V, 0, "Time is column 1 'time, in s', in s."),
    ("clock h:min:s,ms", rows(lambda i: f"{clock(i)};{force(i):.4f}", head="Zeit;Kraft [N]"), V, 0, "a clock (h:min:s)"),
    ("German date and time", rows(lambda i: f"12.05.2024 {clock(i)};{force(i):.4f}", head="Zeit;Kraft [N]"), V, 0, "a clock (h:min:s)"),
    ("date and clock in columns of their own, decimal commas", rows(lambda i: f"12.05.2024;{clock(i)};{force(i):.4f}".replace(".", ",").replace("12,05,2024", "12.05.2024"), head="Datum;Uhrzeit;Kraft in N"), V, 0, "Time is column 2 'Uhrzeit', a clock (h:min:s)."),
    ("the same with points in the clock", rows(lambda i: f"12.05.2024;{clock(i).replace(',', '.')};{force(i):.4f}".replace(f";{force(i):.4f}", f";{force(i):.4f}".replace(".", ",")), head="Datum;Uhrzeit;Kraft in N"), V, 0, "The comma is the decimal sign."),
    ("a comma in the seconds, commas between the columns", rows(lambda i: f"2024-05-12 {clock(i)},{force(i):.4f}", head="time,force [N]"), V, 0, "Force is column 2 'force [N]', in N."),
    ("dates of the United States with AM and PM", rows(lambda i: f"5/12/2024 {clock(i).replace(',', '.')} PM,{force(i):.4f}", head="time,force [N]"), V, 0, "a clock (h:min:s)"),
    ("stamps in whole seconds", rows(lambda i: f"12:00:{i // 100:02d},{force(i):.4f}", head="time,force [N]"), V, 3, "give the sampling rate (--sample-rate 100)"),
    ("numbers that end with their decimal comma", rows(lambda i: f"{i},\t{force(i):.1f}".replace(".0", ".").replace(".", ","), head="Zeit [s]\tKraft [N]"), V, 0, "The comma is the decimal sign."),
    ("Excel's serial dates", rows(lambda i: f"{45000 + i / 8640000:.9f},{force(i):.4f}", head="time,force [N]"), V, 0, "of the size of Excel's dates"),
    ("force over displacement, no clock", rows(lambda i: f"{i / 10},{force(i):.4f}", head="displacement [mm],force [N]"), V, 0, "t = x/V"),
    ("no clock, no displacement", rows(lambda i: f"{force(i):.4f}", head="force [N]"), V, 3, "give the sampling rate with --sample-rate"),
    ("the same with --sample-rate", rows(lambda i: f"{force(i):.4f}", head="force [N]"), [*V, "--sample-rate", "100"], 0, "Time is counted from 0 at 100 samples per second"),
    ("volts", rows(lambda i: f"{i / 100},{force(i):.4f}", head="time [s],Load cell force [V]"), V, 3, "--force-scale '5 N/V'"),
    ("volts with --force-scale", rows(lambda i: f"{i / 100},{1e3 * force(i):.1f}", head="time [s],Load cell force [mV]"), [*V, "--force-scale", "5 N/V"], 0, "in mV, at 5 N/V (as stated)"),
    ("a unit that is none", rows(lambda i: f"{i / 100},{force(i):.4f}", head="time [s],Force (raw)"), V, 3, "'raw' is not a unit of force"),
    ("the same with --force-scale", rows(lambda i: f"{i / 100},{force(i):.4f}", head="time [s],Force (raw)"), [*V, "--force-scale", "0.5 N/raw"], 0, "in raw, at 0.5 N/raw (as stated)"),
    ("kips", rows(lambda i: f"{i / 100},{force(i):.4f}", head="time [s],Force (kip)"), V, 0, "Force is column 2 'Force (kip)', in kip."),
    ("a torque", rows(lambda i: f"{i / 100},{force(i):.4f}", head="time [s],Torque [in lbf]"), V, 3, "is a torque; give the distance of the contact from the axis with --radius"),
    ("the same with --radius", rows(lambda i: f"{i / 100},{force(i):.4f}", head="time [s],Torque [in lbf]"), [*V, "--radius", "12mm"], 0, "Force is column 2 'Torque [in lbf]', a torque (unit in lbf), divided by the radius of 0.012 m."),
    ("names in French", rows(lambda i: f"{i / 100};4;{force(i):.4f}", head="Temps (s);Force normale (N);Force tangentielle (N)"), V, 0, "Normal force is column 2 'Force normale (N)': 4 N"),
    ("a friction coefficient beside a load", rows(lambda i: f"{i / 100},{force(i) / 4:.5f},4", head="time [s],COF,Fz [N]"), V, 0, "Force is the friction coefficient times column 3 'Fz [N]'."),
    ("a column of speeds, no --speed", rows(lambda i: f"{i / 100},{force(i):.4f},10", head="time [s],force [N],speed [mm/s]"), [], 0, "Speed is column 3 'speed [mm/s]': 0.01 m/s"),
    ("no speed anywhere", PLAIN, [], 2, "--speed is missing"),
    ("--speed 10 mm/s without quotes", PLAIN, ["--speed", "10", "mm/s"], 0, "Force is column 2 'force [N]', in N."),
    ("steps whose clock begins again", STEPS, [], 0, "only step 1 was analysed"),
    ("one of them with --step", STEPS, ["--step", "2"], 0, "Only step 2 was read"),
    ("a sweep in one file with --segments", SWEEP, ["--segments"], 0, "segment 3"),
    ("strokes of a reciprocating test", rows(lambda i: f"{i / 100},{strokes(i):.4f}", 1600), V, 0, "8 strokes were analysed together"),
    ("the same with --strokes", rows(lambda i: f"{i / 100},{strokes(i):.4f}", 1600), [*V, "--strokes"], 0, "stroke 2 (-)"),
    ("--sheet on plain text", PLAIN, [*V, "--sheet", "2"], 3, "is plain text, which has no sheets"),
    ("gzip", gzip.compress(PLAIN.encode()), V, 0, "The file is compressed (gzip)."),
    ("a zip archive of two files", zipped("a.csv", "b.csv"), V, 3, "the zip archive contains 2 files"),
    ("one of them with --sheet", zipped("a.csv", "b.csv"), [*V, "--sheet", "b.csv"], 0, "'b.csv' was read."),
    ("TDMS whose last block is cut off", tdms(40), V, 0, "the last block of the TDMS file is cut off"),
    ("standard input (-)", None, V, 0, "Force is column 2 'force [N]', in N."),
    ("a folder", "", V, 3, "is a folder"),
]


def table():
    lines = ["| input | options | exit | says |", "|---|---|---|---|"]
    for title, _, options, code, says in INPUTS:
        words = " ".join(f"'{o}'" if " " in o else o for o in options) or " "
        lines.append(f"| {title} | `{words}` | {code} | {says} |".replace("` `", ""))
    return "\n".join(lines)


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    wrong = [] if table() in PAGE.read_text() else [f"{PAGE}: is not the table that {sys.argv[0]} --table prints"]
    with tempfile.TemporaryDirectory() as folder:
        for n, (title, content, options, code, says) in enumerate(INPUTS):
            file = pathlib.Path(folder) / f"input{n}.csv"
            if content is None:
                name, given = "-", PLAIN.encode()
            else:
                name, given = str(file) if content else folder, b""
                file.write_bytes(content if isinstance(content, bytes) else content.encode())
            done = subprocess.run([program, "fit", name, "--details", *options], input=given, capture_output=True, timeout=60)
            answer, message = done.stdout.decode(), done.stderr.decode()
            is_line = done.returncode == 0 or message.count("\n") == 1
            if done.returncode != code or says not in answer + message or not is_line:
                wrong.append(f"{title}: exit {done.returncode}, expected {code} and '{says}':\n{answer[:1500]}{message}")
    print("\n".join(wrong) if wrong else f"{len(INPUTS)} inputs")
    sys.exit(1 if wrong else 0)


if sys.argv[1] == "--table":
    print(table())
else:
    main()
