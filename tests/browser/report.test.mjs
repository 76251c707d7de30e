// Opens pages of slipfit in a headless Chromium. Run by scripts/test-report.sh, which sets
// SLIPFIT (the program of the build), CHROMIUM (the browser), SHOTS (a folder for pages and screenshots).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const { SLIPFIT, CHROMIUM, SHOTS } = process.env;
const kLargestPage = 3_000_000; // bytes, for 200 000 samples
const kHostile = "</script><script>alert(1)</script>.csv"; // three folders deep: a name cannot hold a slash
const demo = "testdata/demo.csv";
const synthetic = "../shared/data/synthetic/manifest.csv"; // where it is absent, recordings are simulated

function slipfit(...words) {
  return execFileSync(SLIPFIT, words, { stdio: ["ignore", "pipe", "pipe"], maxBuffer: 1 << 30 });
}
const shot = (name) => path.join(SHOTS, name);

function simulate(name, duration_s) {
  const model = ["--stiffness", "5000", "--natural-frequency", "900", "--damping-ratio", "0.05", "--static-friction",
    "4.2", "--kinetic-friction", "3.2"];
  slipfit("simulate", ...model, "--speed", "10mm/s", "--duration", `${duration_s}`, "--sample-rate", "10kHz", "--noise",
    "0.02", "--jitter", "0.05", "--seed", "1", "--out", shot(name));
}
function report(recording, name, speed = "10mm/s") {
  slipfit("fit", recording, "--speed", speed, "--report", shot(name), "--quiet");
  return shot(name);
}

let browser;
before(async () => {
  fs.mkdirSync(SHOTS, { recursive: true });
  browser = await chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox"] });
});
after(async () => browser?.close());

/** Opens a page and notes everything that a self-contained page must not do. */
async function open(file, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, ...options });
  page.faults = [];
  page.on("console", (message) => page.faults.push(`console: ${message.text()}`));
  page.on("pageerror", (error) => page.faults.push(`error: ${error.message}`));
  page.on("dialog", (dialog) => {
    page.faults.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  const own = pathToFileURL(file).href;
  page.on("request", (request) => {
    const url = request.url();
    if (url !== own && !url.startsWith("data:")) page.faults.push(`request: ${url}`);
  });
  await page.goto(own);
  return page;
}
/** Pixels of the traces' canvases that something was drawn on. */
function drawnPixels(page) {
  return page.evaluate(() =>
    [...document.querySelectorAll("#trace-section canvas")].reduce((sum, canvas) => {
      const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
      let drawn = 0;
      for (let i = 3; i < data.length; i += 4) drawn += data[i] > 0 ? 1 : 0;
      return sum + drawn;
    }, 0));
}
async function shownRange(page) {
  const { begin, end } = await page.locator("#trace-section").evaluate((section) => ({ ...section.dataset }));
  return [Number(begin), Number(end)];
}
const width = (range) => range[1] - range[0];

test("the demo's page draws, zooms, moves and reads off", async () => {
  const page = await open(report(demo, "demo.html"));
  assert.ok((await drawnPixels(page)) > 5000, "the interactive trace is drawn");
  const charts = await page.locator("svg.chart").evaluateAll((all) =>
    all.filter((svg) => !svg.closest(".still")).map((svg) => ({ id: svg.id, width: svg.getBoundingClientRect().width,
      paths: svg.querySelectorAll("path").length, label: svg.getAttribute("aria-label") })));
  assert.deepEqual(charts.map((chart) => chart.id), ["spectrum", "cycles", "residuals", "evolution", "pairs", "map", "speed", "pattern"]);
  for (const chart of charts) assert.ok(chart.width > 300 && chart.paths > 2 && chart.label.length > 20, chart.id);

  const whole = await shownRange(page);
  await page.locator("#trace-force").scrollIntoViewIfNeeded();
  const box = await page.locator("#trace-force").boundingBox();
  await page.mouse.move(box.x + 0.4 * box.width, box.y + 100);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 100, { steps: 4 });
  await page.mouse.up();
  const dragged = await shownRange(page);
  assert.ok(width(dragged) < 0.2 * width(whole), "dragging zooms");
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 120);
  assert.match(await page.locator("#trace-readoff").textContent(), /time .* s.*measured .* N.*fit .* N.*residual/);
  await page.screenshot({ path: shot("demo-zoomed.png") });

  await page.locator("#trace-section .live").focus();
  await page.keyboard.press("ArrowRight");
  assert.ok((await shownRange(page))[0] > dragged[0], "the arrow key moves");
  await page.keyboard.press("-");
  assert.ok(width(await shownRange(page)) > 1.9 * width(dragged), "minus zooms out");
  await page.getByRole("button", { name: "Whole recording" }).click();
  assert.deepEqual(await shownRange(page), whole);
  await page.getByRole("button", { name: "Next slip" }).click();
  assert.ok(width(await shownRange(page)) < 0.2 * width(whole), "the next slip comes close up");
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("the data of a chart are read back from its picture", async () => {
  const page = await open(report(demo, "demo.html"));
  const [download] = await Promise.all([page.waitForEvent("download"),
    page.getByRole("button", { name: "Save the data of the chart spectrum as CSV" }).click()]);
  const rows = fs.readFileSync(await download.path(), "utf8").trim().split("\n").map((row) => row.match(/"[^"]*"|[^,]+/g));
  assert.deepEqual(rows[0], ["panel", "series", "x", "y"]);
  const lines = rows.filter(([, name]) => /^"chosen frequency, 24\.57.* Hz, rms per bin \[N\] over frequency \[Hz\]"$/.test(name));
  assert.equal(lines.length, 2);
  // A tenth of a pixel is 0.14 % on this axis, of three decades over 610 pixels.
  for (const [, , x] of lines) assert.ok(Math.abs(Number(x) / 24.57 - 1) < 2e-3, x);
  assert.ok(rows.filter(([, name]) => name.startsWith('"harmonics found, ')).length > 2, "of markers, too");
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("a hostile file name stays text", async () => {
  const file = path.join(SHOTS, kHostile);
  fs.mkdirSync(path.dirname(file), { recursive: true });
  fs.copyFileSync(demo, file);
  const page = await open(report(file, "hostile.html"));
  assert.ok((await page.locator("p.file").textContent()).endsWith(kHostile));
  assert.equal(await page.title(), path.basename(kHostile));
  assert.equal(await page.locator("h1").textContent(), path.basename(kHostile));
  assert.equal(await page.locator("script").count(), 3);
  assert.ok((await drawnPixels(page)) > 5000);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("the page of a comparison shows the cycles of both sides", async () => {
  simulate("other.csv", 2);
  slipfit("compare", demo, shot("other.csv"), "--speed", "10mm/s", "--quiet", "--out", shot("compare.txt"), "--report",
    shot("compare.html"));
  const page = await open(shot("compare.html"));
  assert.ok((await page.locator("#quantities tbody tr").count()) > 5);
  assert.ok((await page.locator("svg#cycles path").count()) >= 4);
  await page.screenshot({ path: shot("compare.png"), fullPage: true });
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("200 000 samples: small enough, painted soon", async (context) => {
  simulate("long.csv", 20);
  const file = report(shot("long.csv"), "long.html");
  const size = fs.statSync(file).size;
  assert.ok(size <= kLargestPage, `${size} bytes`);
  const page = await open(file);
  await page.waitForFunction(() => performance.getEntriesByName("first-contentful-paint").length > 0);
  const paint_ms = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime);
  context.diagnostic(`200 000 samples: ${size} bytes, first paint after ${Math.round(paint_ms)} ms`);
  assert.ok((await drawnPixels(page)) > 5000);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("10^6 samples stay fluent", async (context) => {
  simulate("million.csv", 100);
  const page = await open(report(shot("million.csv"), "million.html"));
  const frame_ms = await page.evaluate(() => {
    const zoomIn = document.querySelector("[data-do=in]");
    const start = performance.now();
    for (let i = 0; i < 10; ++i) zoomIn.click();
    return (performance.now() - start) / 10;
  });
  context.diagnostic(`10^6 samples: ${fs.statSync(shot("million.html")).size} bytes, ${frame_ms.toFixed(1)} ms a zoom`);
  assert.ok((await drawnPixels(page)) > 5000);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("screenshots: light, dark, narrow, paper", async () => {
  const file = report(demo, "demo.html");
  for (const [name, options] of [["light", {}], ["dark", { colorScheme: "dark" }],
    ["narrow", { viewport: { width: 420, height: 800 } }]]) {
    const page = await open(file, options);
    await page.screenshot({ path: shot(`demo-${name}.png`), fullPage: true });
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    assert.ok(overflow <= 0, `${name}: wider than the window by ${overflow} px`);
    if (name === "light") await page.pdf({ path: shot("demo.pdf"), preferCSSPageSize: true });
    assert.deepEqual(page.faults, []);
    await page.close();
  }
});

/** The charts that are visible on paper, by their ids; the page as a PDF is left beside it to be looked at. */
async function printedCharts(file) {
  const page = await open(file);
  await page.pdf({ path: file.replace(/html$/, "pdf"), preferCSSPageSize: true });
  await page.emulateMedia({ media: "print" });
  const ids = await page.locator("svg.chart, svg.spark").evaluateAll((all) =>
    all.filter((svg) => svg.getBoundingClientRect().height > (svg.classList.contains("spark") ? 5 : 50))
      .map((svg) => svg.id || "spark"));
  assert.deepEqual(page.faults, []);
  await page.close();
  return ids;
}

test("every kind of page prints all of its charts", async () => {
  assert.deepEqual(await printedCharts(report(demo, "demo.html")),
    ["trace", "spectrum", "cycles", "residuals", "evolution", "pairs", "map", "speed", "pattern"]);
  slipfit("analyze", demo, "--speed", "10mm/s", "--report", shot("print-analyze.html"), "--quiet");
  assert.deepEqual(await printedCharts(shot("print-analyze.html")), ["trace", "spectrum", "cycles", "evolution", "pattern"]);
  addHum(demo, shot("print-hum.csv"));
  assert.deepEqual(await printedCharts(report(shot("print-hum.csv"), "print-hum.html")),
    ["trace", "spectrum", "cycles", "residuals", "evolution", "pairs", "map", "speed", "pattern"]);
  const rows = sweep("print", [4, 5, 7, 10, 20]).map((run) => `${run.name},${run.name}.csv,${run.speed},print`);
  fs.writeFileSync(shot("print.csv"), `id,file,speed [mm/s],group\n${rows.join("\n")}\n`);
  slipfit("fit", "--joint", shot("print.csv"), "--report", shot("print-sweep.html"), "--quiet");
  assert.deepEqual(await printedCharts(shot("print-sweep.html")),
    ["sweep-spacing", "sweep-friction", "sweep-cycles", "sweep-traces", "sweep-traces-2"]);
  fs.rmSync(shot("print-results"), { recursive: true, force: true });
  slipfit("batch", shot("print.csv"), "--out", shot("print-results"), "--report", shot("print-batch.html"), "--quiet");
  assert.deepEqual(await printedCharts(shot("print-batch.html")), [...rows.map(() => "spark"), ...kDistributions]);
  slipfit("compare", shot("print-5.csv"), shot("print-10.csv"), "--speed", "10mm/s", "--quiet", "--out", shot("print.txt"),
    "--report", shot("print-compare.html"));
  assert.deepEqual(await printedCharts(shot("print-compare.html")), ["cycles"]);
  const ridges = Array.from({ length: 4000 }, (_, i) => `${2 * i},${Math.sin((2 * Math.PI * 2 * i) / 400).toFixed(5)}`);
  fs.writeFileSync(shot("print-profile.csv"), `x [um],z [um]\n${ridges.join("\n")}\n`);
  slipfit("surface", shot("print-profile.csv"), "--report", shot("print-surface.html"), "--quiet");
  assert.deepEqual(await printedCharts(shot("print-surface.html")), ["profile"]);
});

const kDistributions = ["frequency_Hz", "pattern_spacing_m", "stiffness_N_per_m", "friction_difference_N", "damping_ratio"];

/** The recording with hum of 50 Hz and a line of another origin. */
function addHum(file, name) {
  const lines = fs.readFileSync(file, "utf8").trim().split("\n").filter((line) => !line.startsWith("#"));
  const rows = lines.slice(1).map((line) => {
    const [time, force] = line.split(",").map(Number);
    const hum = 0.15 * Math.sin(2 * Math.PI * 50.03 * time + 1) + 0.1 * Math.sin(2 * Math.PI * 271.3 * time);
    return `${time},${(force + hum).toFixed(6)}`;
  });
  fs.writeFileSync(name, `${[lines[0], ...rows].join("\n")}\n`);
}

/** Recordings of several speeds; the file names begin with `prefix`. */
function sweep(prefix, speeds = [5, 10, 20]) {
  return speeds.map((speed) => {
    const name = `${prefix}-${speed}`;
    const model = ["--stiffness", "5000", "--natural-frequency", "900", "--damping-ratio", "0.05", "--static-friction",
      "4.2", "--kinetic-friction", "3.2"];
    slipfit("simulate", ...model, "--speed", `${speed}mm/s`, "--duration", "2", "--sample-rate", "5kHz", "--noise", "0.02",
      "--jitter", "0.05", "--seed", `${speed}`, "--out", shot(`${name}.csv`));
    return { name, speed };
  });
}

/** The manifest of a batch: all synthetic recordings, or three, and two rows that a page must survive. */
function batchManifest() {
  const lines = fs.existsSync(synthetic)
    ? fs.readFileSync(synthetic, "utf8").trim().split("\n").map((line, i) => {
        const cells = line.split(",");
        const file = fs.readFileSync(synthetic, "utf8").split("\n")[0].split(",").indexOf("file");
        if (i > 0) cells[file] = path.resolve(path.dirname(synthetic), cells[file]);
        return cells.join(",");
      })
    : ["id,file,speed [mm/s]", ...sweep("run").map((run) => `${run.name},${run.name}.csv,${run.speed}`)];
  const columns = lines[0].split(",");
  const row = (id, file) => columns.map((name) =>
    ({ id, file: path.resolve(file), group: "" })[name] ?? lines[1].split(",")[columns.indexOf(name)]).join(",");
  lines.push(row(kHostileId, demo), row("broken", `none${kHostile}`));
  fs.writeFileSync(shot("batch.csv"), `${lines.join("\n")}\n`);
  return { file: shot("batch.csv"), recordings: lines.length - 2 };
}
const kHostileId = "<script>alert(1)<img src=x onerror=alert(1)>";

/** What the command says with exit code 1, some recordings failed. */
function batch(...words) {
  const failed = (() => {
    try {
      slipfit("batch", ...words);
    } catch (error) {
      return error;
    }
  })();
  assert.equal(failed?.status, 1, failed?.stderr?.toString());
}

test("a batch's page sorts, filters, finds and links to each recording's page", async (context) => {
  const { file, recordings } = batchManifest();
  fs.rmSync(shot("results"), { recursive: true, force: true });
  batch(file, "--out", shot("results"), "--report", shot("results/index.html"), "--quiet");
  const page = await open(shot("results/index.html"), { viewport: { width: 1280, height: 900 } });
  const rows = page.locator("#recordings tbody tr");
  context.diagnostic(`${recordings} recordings`);
  assert.equal(await rows.count(), recordings);
  assert.equal(await page.locator("svg.spark path").count(), recordings);

  const values = (cell) => rows.evaluateAll((all, i) => all.map((row) => row.cells[i].dataset.value), cell);
  const known = (cells) => cells.filter((value) => value !== "").map(Number);
  const sorted = (numbers, sign) => numbers.every((value, i) => i === 0 || sign * (value - numbers[i - 1]) >= 0);
  await page.getByRole("button", { name: /^frequency/ }).click();
  const rising = await values(4);
  assert.ok(known(rising).length > 2 && sorted(known(rising), 1), "by number and not by text");
  assert.deepEqual(rising.slice(known(rising).length).filter((value) => value !== ""), [], "what is not known stands last");
  await page.getByRole("button", { name: /^speed/ }).press("Enter");
  await page.getByRole("button", { name: /^speed/ }).press("Enter");
  assert.ok(sorted(known(await values(3)), -1), "falling speed, by keyboard");
  assert.equal(await page.locator("th[aria-sort]").count(), 1);

  await page.getByLabel("Show").selectOption("stick_slip");
  assert.deepEqual([...new Set(await rows.evaluateAll((all) => all.map((row) => row.dataset.status)))], ["stick_slip"]);
  await page.getByLabel("Show").selectOption("");
  await page.screenshot({ path: shot("batch-top.png") });
  await page.screenshot({ path: shot("batch.png"), fullPage: true });
  await page.pdf({ path: shot("batch.pdf"), preferCSSPageSize: true });
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  assert.ok(overflow <= 0, `wider than the window by ${overflow} px`);

  assert.equal(await page.locator("#failures th[scope=row]").textContent(), "broken");
  assert.match(await page.locator("#failures td").first().textContent(), /<script>alert\(1\)<\/script>\.csv/);
  await page.getByLabel("Search").fill("<SCRIPT>alert(1)<img");
  assert.equal(await page.locator("#shown").textContent(), `1 of ${recordings}`);
  assert.deepEqual(page.faults, []);
  await page.getByRole("link", { name: kHostileId }).click();
  await page.waitForURL(/recordings\/\d+-.*\.html$/);
  assert.match(await page.title(), /demo\.csv$/);
  assert.ok((await drawnPixels(page)) > 5000);
  assert.deepEqual(page.faults.filter((fault) => !/^request: file:.*\/recordings\/\d+-[\w.-]+\.html$/.test(fault)), []);
  await page.close();
});

test("a table of 10^4 rows opens and sorts soon", async (context) => {
  const index = fs.readFileSync(shot("results/index.html"), "utf8");
  const rows = index.match(/<tr data-status[^]*?<\/tr>/g);
  const many = Array.from({ length: 10_000 }, (_, i) => rows[i % rows.length]);
  const filled = index.replace(/<tbody>[^]*?<\/tbody>/, () => `<tbody>${many.slice(0, 500).join("")}</tbody>`)
    .replace(/<template id="later">[^]*?<\/template>/, () => `<template id="later">${many.slice(500).join("")}</template>`);
  fs.writeFileSync(shot("many.html"), filled);
  const page = await open(shot("many.html"));
  await page.waitForFunction(() => performance.getEntriesByName("first-contentful-paint").length > 0);
  const paint_ms = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime);
  assert.equal(await page.locator("#shown").textContent(), "10000 of 10000");
  const sort_ms = await page.evaluate(() => {
    const begin = performance.now();
    document.querySelector("#recordings th:nth-child(5) button").click();
    document.body.getBoundingClientRect();
    return performance.now() - begin;
  });
  const key_ms = await page.evaluate(() => {
    const search = document.getElementById("search");
    const begin = performance.now();
    search.value = "slip";
    search.dispatchEvent(new Event("input"));
    document.body.getBoundingClientRect();
    return performance.now() - begin;
  });
  context.diagnostic(`10^4 rows: ${filled.length} bytes, first paint after ${Math.round(paint_ms)} ms, ` +
    `sorted in ${Math.round(sort_ms)} ms, searched in ${Math.round(key_ms)} ms`);
  await page.getByLabel("Search").fill("");
  assert.equal(await page.locator("#recordings tbody tr").count(), 500);
  await page.getByRole("button", { name: "Show 500 more" }).click();
  assert.equal(await page.locator("#recordings tbody tr").count(), 1000);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("the sweep's page draws without script", async () => {
  const rows = sweep("sweep").map((run) => `${run.name},${run.name}.csv,${run.speed},pair`);
  fs.writeFileSync(shot("manifest.csv"), `id,file,speed [mm/s],group\n${rows.join("\n")}\n`);
  slipfit("fit", "--joint", shot("manifest.csv"), "--group", "pair", "--report", shot("sweep.html"), "--quiet");
  const page = await open(shot("sweep.html"));
  assert.deepEqual(await page.locator("svg.chart").evaluateAll((all) => all.map((svg) => svg.id)),
    ["sweep-spacing", "sweep-friction", "sweep-cycles", "sweep-traces"]);
  assert.equal(await page.locator(".plain-table tbody tr").count(), 3);
  const names = page.locator("#sweep-cycles-section .legend-list li");
  assert.equal(await names.first().isVisible(), false, "the legend stands in the chart");
  await page.setViewportSize({ width: 400, height: 800 });
  for (const box of await Promise.all((await names.all()).map((name) => name.boundingBox()))) {
    assert.ok(box.x >= 0 && box.x + box.width <= 400, "the legend is inside a narrow screen");
  }
  await page.setViewportSize({ width: 1280, height: 800 });
  await page.screenshot({ path: shot("sweep.png"), fullPage: true });
  assert.deepEqual(page.faults, []);
  await page.close();
});
