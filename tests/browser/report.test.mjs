// Opens pages of slipfit in a headless Chromium. Run by scripts/test-report.sh, which sets
// SLIPFIT and BATCH_PAGE (programs of the build), CHROMIUM (the browser), SHOTS (a folder for pages and screenshots).
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
  assert.deepEqual(charts.map((chart) => chart.id), ["spectrum", "cycles", "pairs", "map", "speed", "pattern"]);
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

test("a hostile file name stays text", async () => {
  const file = path.join(SHOTS, kHostile);
  fs.mkdirSync(path.dirname(file), { recursive: true });
  fs.copyFileSync(demo, file);
  const page = await open(report(file, "hostile.html"));
  assert.ok((await page.locator("p.file").textContent()).endsWith(kHostile));
  assert.ok((await page.title()).endsWith(kHostile));
  assert.equal(await page.locator("script").count(), 3);
  assert.ok((await drawnPixels(page)) > 5000);
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

/** A sweep of three speeds, each with its fit document; the file names begin with `prefix`. */
function sweep(prefix) {
  return [5, 10, 20].map((speed) => {
    const name = `${prefix}-${speed}`;
    const model = ["--stiffness", "5000", "--natural-frequency", "900", "--damping-ratio", "0.05", "--static-friction",
      "4.2", "--kinetic-friction", "3.2"];
    slipfit("simulate", ...model, "--speed", `${speed}mm/s`, "--duration", "2", "--sample-rate", "5kHz", "--noise", "0.02",
      "--jitter", "0.05", "--seed", `${speed}`, "--out", shot(`${name}.csv`));
    slipfit("fit", shot(`${name}.csv`), "--speed", `${speed}mm/s`, "--json", "--out", shot(`${name}.json`), "--report",
      shot(`${name}.html`), "--quiet");
    return { name, speed };
  });
}

test("the batch's table sorts, filters and links", async () => {
  const names = sweep("run").map((run) => run.name);
  const file = shot("index.html");
  execFileSync(process.env.BATCH_PAGE, [file, ...names.map((name) => shot(`${name}.json`))]);
  const page = await open(file, { viewport: { width: 1280, height: 900 } });
  const firstCells = () => page.locator("#recordings tbody tr:visible td.name").allTextContents();
  const speed = page.getByRole("button", { name: /^speed/ });
  await speed.click();
  await speed.click();
  assert.deepEqual(await firstCells(), ["run-20", "run-10", "run-5"], "falling speed");
  await page.getByRole("button", { name: /^frequency/ }).click();
  assert.deepEqual(await firstCells(), ["run-5", "run-10", "run-20"], "rising frequency, by number and not by text");
  assert.equal(await page.locator("th[aria-sort]").count(), 1);
  await page.getByLabel("Search").fill("run-1");
  assert.deepEqual(await firstCells(), ["run-10"]);
  assert.equal(await page.locator("#shown").textContent(), "1 of 3");
  await page.getByLabel("Search").fill("");
  await page.screenshot({ path: shot("batch.png"), fullPage: true });
  assert.equal(await page.locator("svg.spark path").count(), 3);
  assert.equal(await page.locator("#failures th[scope=row]").textContent(), "</script><script>alert(1)</script>");
  await page.getByRole("link", { name: "run-10" }).click();
  assert.match(await page.title(), /run-10\.csv$/);
  assert.deepEqual(page.faults.filter((fault) => !fault.endsWith("/run-10.html")), []);
  await page.close();
});

test("the sweep's page draws without script", async () => {
  const rows = sweep("sweep").map((run) => `${run.name},${run.name}.csv,${run.speed},pair`);
  fs.writeFileSync(shot("manifest.csv"), `id,file,speed [mm/s],group\n${rows.join("\n")}\n`);
  slipfit("fit", "--joint", shot("manifest.csv"), "--group", "pair", "--report", shot("sweep.html"), "--quiet");
  const page = await open(shot("sweep.html"));
  assert.deepEqual(await page.locator("svg.chart").evaluateAll((all) => all.map((svg) => svg.id)),
    ["sweep-spacing", "sweep-friction", "sweep-traces"]);
  assert.equal(await page.locator(".plain-table tbody tr").count(), 3);
  await page.screenshot({ path: shot("sweep.png"), fullPage: true });
  assert.deepEqual(page.faults, []);
  await page.close();
});
