// The German words of the page against what they translate.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
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

const german = vm.runInNewContext(`${fs.readFileSync("web/german_report.js", "utf8")}; ({ table: kGermanReport, of: germanOf })`);
const sources = ["src", "include"].flatMap((folder) => fs.readdirSync(folder, { recursive: true })
  .filter((file) => /\.(cpp|hpp|html|js)$/.test(file)).map((file) => fs.readFileSync(path.join(folder, file), "utf8")))
  .join("\n").replace(/"\s*\n\s*"/g, "");

test("each heading of a page has its German words", () => {
  const pages = fs.readdirSync("src/report/html").map((file) => fs.readFileSync(path.join("src/report/html", file), "utf8"))
    .join("\n");
  const titles = [/Figure(?: figure)?\{\s*"[\w-]+",\s*"([^"]+)"/g, /\? "(The [^"]+)" : "(The [^"]+)"/g,
    /\bsection\([^;]*?,\s*"([A-Z][^"<>]+)",/g, /<h2>([^<{]+)<\/h2>/g]
    .flatMap((pattern) => [...pages.matchAll(pattern)].flatMap((match) => match.slice(1)));
  assert.ok(titles.length > 20, `${titles.length} headings were found`);
  assert.deepEqual(titles.filter((title) => !german.of(title)), []);
});

test("each status has its German word", () => {
  const names = /name_in\(\{([^}]*)\}, status\)/.exec(fs.readFileSync("src/report/names.cpp", "utf8"))[1];
  assert.deepEqual([...names.matchAll(/"(\w+)"/g)].map((match) => match[1]).filter((name) => !german.of(name)), []);
});

test("what the German words translate is still said", () => {
  const isSaid = (words) => sources.includes(words) || words.startsWith(": ") && sources.includes(words.slice(2)) ||
    sources.includes(words.replace("ω", "w").replace("ζ", "zeta").replace("α", "alpha")) || sources.includes(words.replace("friction force ", ""));
  assert.deepEqual([...german.table.keys()].filter((words) => !isSaid(words)), []);
});
