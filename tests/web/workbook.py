"""workbook.py CSV XLSX: the rows of a CSV as a workbook, with a sheet of notes before them; by the standard library alone."""
import csv
import sys
import zipfile

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
RELATIONS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006/relationships"


def cell(text):
    try:
        return f"<c><v>{float(text)!r}</v></c>"
    except ValueError:
        return f'<c t="inlineStr"><is><t>{text}</t></is></c>'


def sheet(rows):
    lines = "".join(f"<row>{''.join(map(cell, row))}</row>" for row in rows)
    return f'<worksheet xmlns="{MAIN}"><sheetData>{lines}</sheetData></worksheet>'


def relation(number, kind, target):
    return f'<Relationship Id="rId{number}" Type="{RELATIONS}/{kind}" Target="{target}"/>'


with open(sys.argv[1], encoding="utf-8") as file:
    rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
with zipfile.ZipFile(sys.argv[2], "w", zipfile.ZIP_DEFLATED) as book:
    book.writestr("_rels/.rels", f'<Relationships xmlns="{PACKAGE}">{relation(1, "officeDocument", "xl/workbook.xml")}</Relationships>')
    book.writestr("xl/workbook.xml", f'<workbook xmlns="{MAIN}" xmlns:r="{RELATIONS}"><sheets><sheet name="notes" sheetId="1" r:id="rId1"/>'
                                     '<sheet name="run" sheetId="2" r:id="rId2"/></sheets></workbook>')
    book.writestr("xl/_rels/workbook.xml.rels", f'<Relationships xmlns="{PACKAGE}">{relation(1, "worksheet", "worksheets/sheet1.xml")}'
                                                f'{relation(2, "worksheet", "worksheets/sheet2.xml")}</Relationships>')
    book.writestr("xl/worksheets/sheet1.xml", sheet([["operator", "A"]]))
    book.writestr("xl/worksheets/sheet2.xml", sheet(rows))
