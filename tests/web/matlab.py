"""matlab.py CSV MAT: the columns of a CSV as variables of MATLAB 5, compressed as MATLAB 7 does; by the standard library alone."""
import csv
import struct
import sys
import zlib

MATRIX, COMPRESSED, INT8, INT32, UINT32, DOUBLE = 14, 15, 1, 5, 6, 9  # types of elements
CLASS_DOUBLE = 6


def element(kind, content):
    return struct.pack("<II", kind, len(content)) + content + bytes(-len(content) % 8)


def variable(name, values):
    array = element(MATRIX, element(UINT32, struct.pack("<II", CLASS_DOUBLE, 0)) + element(INT32, struct.pack("<ii", len(values), 1)) +
                    element(INT8, name.encode()) + element(DOUBLE, struct.pack(f"<{len(values)}d", *values)))
    packed = zlib.compress(array)
    return struct.pack("<II", COMPRESSED, len(packed)) + packed


with open(sys.argv[1], encoding="utf-8") as file:
    names, *rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
with open(sys.argv[2], "wb") as file:
    file.write(b"MATLAB 5.0 MAT-file, by matlab.py".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49))
    for name, column in zip(names, zip(*rows)):
        file.write(variable(name, [float(value) for value in column]))
