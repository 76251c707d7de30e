// Saving: files, a zip archive of files as they are, numbers with a decimal comma.
function download(name, content) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content]));
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

/** files: [{ name, text }] as a zip archive that stores them without compression (PKWARE APPNOTE 4.3). */
function zipOf(files) {
  const encoder = new TextEncoder();
  const parts = [];
  const directory = [];
  let offset = 0;
  for (const { name, text } of files) {
    const bytes = encoder.encode(text);
    const title = encoder.encode(name);
    // Version 2.0, UTF-8 names, stored, 1 January 1980; the same fields stand in the file's header and in the directory.
    const fields = [[0x14, 2], [0x0800, 2], [0, 2], [0, 2], [0x21, 2], [crc32(bytes), 4], [bytes.length, 4],
      [bytes.length, 4], [title.length, 2], [0, 2]];
    const header = numbers([[0x04034b50, 4], ...fields]);
    directory.push(numbers([[0x02014b50, 4], [0x14, 2], ...fields, [0, 2], [0, 2], [0, 2], [0, 4], [offset, 4]]), title);
    parts.push(header, title, bytes);
    offset += header.length + title.length + bytes.length;
  }
  const size = directory.reduce((sum, part) => sum + part.length, 0);
  const end = numbers([[0x06054b50, 4], [0, 2], [0, 2], [files.length, 2], [files.length, 2], [size, 4], [offset, 4], [0, 2]]);
  return new Blob([...parts, ...directory, end], { type: "application/zip" });
}
/** Pairs of a value and its size, little-endian. */
function numbers(pairs) {
  return Uint8Array.from(pairs.flatMap(([value, size]) => Array.from({ length: size }, (_, i) => (value >>> (8 * i)) & 255)));
}

/** A CSV of numbers as spreadsheets of decimal-comma countries open it. */
function withDecimalComma(csv) {
  return csv.replace(/"[^"]*"|[.,]/g, (part) => ({ ".": ",", ",": ";" })[part] ?? part);
}
