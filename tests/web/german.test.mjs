// The German words of the page against what they translate.
import assert from "node:assert/strict";
import fs from "node:fs";
import { test } from "node:test";
import vm from "node:vm";

test("each warning of docs/formats.md has its meaning in German, and no other has", () => {
  const table = /\n## Warnings\n([^]*?)\n## /.exec(fs.readFileSync("docs/formats.md", "utf8"))[1];
  const codes = table.split("\n").filter((line) => line.startsWith("| `"))
    .flatMap((line) => [...line.split("|")[1].matchAll(/`(\w+)`/g)].map((match) => match[1]));
  const german = vm.runInNewContext(`${fs.readFileSync("web/german_warnings.js", "utf8")}; kGermanWarnings`);
  assert.ok(codes.length > 40);
  assert.deepEqual(Object.keys(german).sort(), codes.sort());
  for (const [code, meaning] of Object.entries(german)) assert.match(meaning, /^[A-ZÄÖÜ].*[.?]$/, code);
});
