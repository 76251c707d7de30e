// The files of folders that are dropped or chosen, as { name, blob }; hidden ones are left out.
const isHidden = (name) => name.startsWith(".") || name === "Thumbs.db" || name === "desktop.ini";

async function filesOfEntry(entry) {
  if (isHidden(entry.name)) return [];
  if (entry.isFile) {
    const file = await new Promise((done, fail) => entry.file(done, fail));
    return [{ name: file.name, blob: file }];
  }
  const reader = entry.createReader();
  const found = [];
  for (;;) { // a part at a time, until there is none
    const part = await new Promise((done, fail) => reader.readEntries(done, fail));
    if (part.length === 0) break;
    for (const inner of part) found.push(...(await filesOfEntry(inner)));
  }
  return found.sort((a, b) => a.name.localeCompare(b.name, undefined, { numeric: true }));
}

/** What was dropped: files, and those of folders. */
async function droppedFiles(transfer) {
  const entries = Array.from(transfer.items ?? [], (item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (!entries.some((entry) => entry.isDirectory)) return Array.from(transfer.files, (file) => ({ name: file.name, blob: file }));
  return (await Promise.all(entries.map(filesOfEntry))).flat();
}

/** What was chosen as a folder. */
function chosenFiles(list) {
  return Array.from(list).filter((file) => !(file.webkitRelativePath || file.name).split("/").some(isHidden))
    .map((file) => ({ name: file.name, blob: file }));
}
