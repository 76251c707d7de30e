// build/web/slipfit.mjs in node against the program: SLIPFIT=build/release/apps/slipfit node --test tests/web/module.test.mjs
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { test } from "node:test";
import load, * as slipfit from "../../build/web/slipfit.mjs";
import { against, hostileFiles, recordings, tally } from "./recordings.mjs";

const demo = fs.readFileSync("testdata/demo.csv");
const text = (value) => JSON.stringify(value);

test("every recording: the numbers, statuses and errors of the program", async (context) => {
  const found = tally();
  for (const { file, options } of recordings()) {
    const got = JSON.parse(slipfit.fit(fs.readFileSync(file), path.basename(file), text(options)));
    const one = await against(got, "fit", file, options);
    assert.deepEqual(one.faults, [], file);
    found.add(one);
  }
  context.diagnostic(found.text());
  if (found.sum.compared === 1) context.diagnostic("skipped: the recordings of ../shared/data are not here");
});

test("damaged files end in the program's own errors", async (context) => {
  const files = hostileFiles();
  const found = tally();
  for (const file of files) {
    const got = JSON.parse(slipfit.fit(fs.readFileSync(file), path.basename(file), text({ speed: "10 mm/s" })));
    const one = await against(got, "fit", file, { speed: "10 mm/s" });
    assert.deepEqual(one.faults, [], file);
    found.add(one);
  }
  context.diagnostic(`${files.length} files: ${found.text()}`);
});

test("an error has a code, a line of text, a remedy and the program's exit code", () => {
  const errorOf = (bytes, options) => JSON.parse(slipfit.fit(bytes, "a.csv", options)).error;
  assert.deepEqual(errorOf(demo, "{}").code, "no_speed");
  assert.equal(errorOf("", text({ speed: 1 })).code, "empty_file");
  assert.equal(errorOf("", text({ speed: 1 })).exit_code, 3);
  for (const wrong of ["{", "[]", "1", text({ out: "/etc/passwd" }), text({ spede: 1 }), text({ "speed;x": 1 }), text({ speed: "ten" })]) {
    const error = errorOf(demo, wrong);
    assert.equal(error.exit_code, 2, wrong);
    assert.match(error.message, /\S/);
    assert.doesNotMatch(error.message, /\n/);
  }
  assert.equal(errorOf(null, "{}").code, "wrong_usage");
});

test("names of files stay names", () => {
  for (const [given, shown] of [["../../etc/passwd", "passwd"], ["C:\\data\\run 1.csv", "run 1.csv"], ["-x.csv", "./-x.csv"],
    ["", "recording"], ["..", "recording"], ["</script>.csv", "script>.csv"], ["säge.csv", "säge.csv"]]) {
    const document = JSON.parse(slipfit.analyze(demo, given, text({ speed: "10 mm/s" })));
    assert.equal(document.recording?.file, shown, given);
  }
});

test("it can hardly be called wrongly", async () => {
  const expected = slipfit.fit(demo, "demo.csv", text({ speed: "10 mm/s" }));
  assert.equal(await slipfit.fit(demo, "demo.csv", text({ speed: "10 mm/s" })), expected);
  assert.equal((await load()).fit(demo, "demo.csv", { speed: "10 mm/s" }), expected);
  const without_unit = JSON.parse(load.fit(new Uint8Array(demo).buffer, "demo.csv", { speed: 0.01 }));
  assert.equal(without_unit.recording.speed_unit, null);
  assert.deepEqual(without_unit.parameters, JSON.parse(expected).parameters);
  assert.equal(slipfit.fit(demo.toString(), "demo.csv", text({ speed: "10 mm/s", normal_force: null, strokes: false })), expected);
});

test("all commands", async () => {
  const speed = { speed: "10 mm/s" };
  const fit = slipfit.fit(demo, "demo.csv", text(speed));
  assert.equal(JSON.parse(slipfit.info(demo, "demo.csv")).rows, 10001);
  assert.match(slipfit.report(demo, "demo.csv", speed), /^<!DOCTYPE html>[^]*slipfit fit demo.csv --speed &#39;10 mm\/s&#39;|10 mm\/s/);
  assert.match(slipfit.cycles(demo, "demo.csv", speed), /^[\w,]+\n/);
  assert.equal(slipfit.curve(demo, "demo.csv", speed).trim().split("\n").length > 9000, true);
  assert.equal(JSON.parse(slipfit.predict(fit, "1mm/s,10mm/s")).rows.length, 2);
  const other = slipfit.run({ command: "simulate", outputs: ["text"], options: { stiffness: 5000, "natural-frequency": 900,
    "damping-ratio": 0.05, "static-friction": 4.2, "kinetic-friction": 3.2, speed: "20mm/s", duration: 2, "sample-rate": "5kHz", noise: 0.02 } });
  const files = [{ name: "a.csv", bytes: demo }, { name: "b.csv", bytes: other.outputs.text }];
  const sweep = JSON.parse(slipfit.sweep(files, { speed: ["10mm/s", "20mm/s"] }));
  assert.equal(sweep.recordings.length, 2);
  const comparison = JSON.parse(slipfit.compare([files[0]], [files[1]], { speed: ["10mm/s", "20mm/s"] }));
  assert.equal(comparison.schema, "slipfit.compare/1");
  const heights = Array.from({ length: 2000 }, (_, i) => `${i},${Math.sin(i / 8) + 0.1 * Math.sin(i * 7.7)}`).join("\n");
  const surface = JSON.parse(slipfit.surface(`x [um],z [um]\n${heights}\n`, "profile.csv"));
  assert.equal(surface.status, "periodic");
});

test("compressed recordings and workbooks are read as by the program", async () => {
  const { gzipSync } = await import("node:zlib");
  const plain = JSON.parse(slipfit.fit(demo, "demo.csv", text({ speed: "10 mm/s" })));
  const packed = JSON.parse(slipfit.fit(gzipSync(demo), "demo.csv.gz", text({ speed: "10 mm/s" })));
  assert.deepEqual(packed.parameters, plain.parameters);
  const book = path.join(fs.mkdtempSync(path.join(os.tmpdir(), "slipfit-")), "demo.xlsx");
  execFileSync("python3", ["tests/web/workbook.py", "testdata/demo.csv", book]);
  const sheet = JSON.parse(slipfit.fit(fs.readFileSync(book), "demo.xlsx", text({ speed: "10 mm/s" })));
  assert.deepEqual(sheet.parameters, plain.parameters);
});

test("containers, whole and damaged, are read as by the program", async (context) => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "slipfit-"));
  const made = execFileSync("python3", ["tests/containers/containers.py", path.resolve(process.env.SLIPFIT), folder], { maxBuffer: 1 << 26 });
  const found = tally();
  for (const [file, option, value] of JSON.parse(made)) {
    const options = { speed: "0.01", ...(option && { [option.slice(2)]: value }) };
    const place = path.join(folder, file);
    const one = await against(JSON.parse(slipfit.fit(fs.readFileSync(place), file, text(options))), "fit", place, options);
    assert.deepEqual(one.faults, [], `${file} ${option ?? ""}`);
    found.add(one);
  }
  context.diagnostic(found.text());
  assert.ok(found.sum.compared >= 7);
  fs.rmSync(folder, { recursive: true });
});

test("100 fits take no more memory than a few", () => {
  for (let i = 0; i < 5; ++i) slipfit.fit(demo, "demo.csv", text({ speed: "10 mm/s" }));
  const before = slipfit.memoryBytes();
  for (let i = 0; i < 100; ++i) slipfit.fit(demo, "demo.csv", text({ speed: "10 mm/s" }));
  assert.equal(slipfit.memoryBytes(), before);
});
