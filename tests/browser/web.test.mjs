// The page build/web/slipfit.html in a headless Chromium or Firefox, from disk and from a static server. Run by
// scripts/test-web.sh, which sets SLIPFIT (the program), WEB_PAGE (the page), SHOTS (a folder) and BROWSER (which, its path).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium, firefox } from "playwright-core";
import { against, difference, recordings, tally, words } from "../web/recordings.mjs";

const { SLIPFIT, BROWSER, SHOTS, WEB_PAGE } = process.env;
const isFirefox = /firefox/.test(BROWSER ?? "");
const skip = WEB_PAGE ? false : "build/web is not here or of other sources; scripts/web.sh makes it";
const kTolerance = 1e-8;
const demo = "testdata/demo.csv";
const shot = (name) => path.join(SHOTS, `${isFirefox ? "firefox" : "chromium"}-${name}.png`);

let browser;
let server;
before(async () => {
  if (skip) return;
  fs.mkdirSync(SHOTS, { recursive: true });
  browser = isFirefox ? await firefox.launch({ executablePath: BROWSER, channel: "moz-firefox" })
    : await chromium.launch({ executablePath: BROWSER, args: ["--no-sandbox"] });
  server = http.createServer((request, response) => {
    const file = path.join(path.dirname(WEB_PAGE), path.basename(request.url));
    if (!fs.existsSync(file)) return response.writeHead(404).end();
    const kind = { ".html": "text/html", ".wasm": "application/wasm", ".mjs": "text/javascript" }[path.extname(file)] ?? "text/plain";
    return response.writeHead(200, { "content-type": kind }).end(fs.readFileSync(file));
  }).listen(0, "127.0.0.1");
  await new Promise((done) => server.on("listening", done));
});
after(async () => {
  await browser?.close();
  server?.close();
});

/** The page, with everything noted that it must not do. */
async function open(address = pathToFileURL(WEB_PAGE).href, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, locale: "en-GB", ...options });
  page.faults = [];
  page.on("console", (message) => { if (message.type() !== "info") page.faults.push(`console: ${message.text()}`); });
  page.on("pageerror", (error) => page.faults.push(`error: ${error.message}`));
  page.on("request", (request) => {
    if (request.url() !== address && !/^(data|blob|about):/.test(request.url())) page.faults.push(`request: ${request.url()}`);
  });
  await page.goto(address);
  return page;
}
async function openDemo(page, file = demo) {
  await page.setInputFiles("#file", file);
  await page.waitForSelector("#trace canvas");
  await idle(page);
}
const idle = (page) => page.waitForFunction(() => document.getElementById("stop").disabled);
async function fit(page) {
  await page.click("#fit");
  await page.waitForFunction(() => !document.getElementById("fit").disabled);
  await idle(page);
}
async function saved(page, kind) {
  if (isFirefox) return savedInPage(page, kind);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(`[data-save=${kind}]`)]);
  return { name: download.suggestedFilename(), file: await download.path() };
}
/** Playwright tells no downloads of Debian's Firefox: what the page hands over is taken from it. */
async function savedInPage(page, kind) {
  const { name, base64 } = await page.evaluate(async (button) => {
    const handed = new Promise((done) => { window.download = (name, content) => done({ name, content }); });
    document.querySelector(`[data-save=${button}]`).click();
    const { name, content } = await handed;
    return { name, base64: base64Of(new Uint8Array(await new Blob([content]).arrayBuffer())) };
  }, kind);
  const file = path.join(SHOTS, `firefox-${name}`);
  fs.writeFileSync(file, Buffer.from(base64, "base64"));
  return { name, file };
}
const reportOf = (page) => page.frameLocator("#page");

test("a first use in ten steps, from disk", { skip }, async () => {
  const page = await open();
  let step = 0;
  const picture = () => page.screenshot({ path: shot(`step-${String(++step).padStart(2, "0")}`) });
  await picture();
  await openDemo(page);
  await picture();
  await page.locator("#understood").scrollIntoViewIfNeeded();
  await page.click("#fit");
  assert.match(await page.locator("#trouble").textContent(), /speed is missing/);
  await picture();
  await page.fill("#option-speed", "600");
  await page.selectOption("#options label:has(#option-speed) select", "mm/min");
  assert.equal(await page.locator("#command").textContent(), 'slipfit fit demo.csv --speed "600 mm/min"');
  await picture();
  await page.locator("#trace-part").scrollIntoViewIfNeeded();
  await picture();
  await page.focus("#window-begin");
  for (let i = 0; i < 2; ++i) await page.keyboard.press("PageUp");
  const handle = await page.locator("#window-end").boundingBox();
  await page.mouse.move(handle.x + handle.width / 2, handle.y + 60);
  await page.mouse.down();
  await page.mouse.move(handle.x - 200, handle.y + 60, { steps: 5 });
  await page.mouse.up();
  await picture();
  const command = await page.locator("#command").textContent();
  assert.match(command, /--window 0\.4:1\.\d+/);
  await fit(page);
  await page.waitForTimeout(600);
  await picture();
  assert.match(await reportOf(page).locator(".headline").textContent(), /stick-slip/i);
  assert.ok((await reportOf(page).locator("svg.chart").count()) >= 5);
  const { file, name } = await saved(page, "document");
  assert.equal(name, "demo.json");
  const typed = command.match(/"[^"]*"|\S+/g).slice(1).map((word) => word.replaceAll('"', ""));
  const expected = JSON.parse(execFileSync(path.resolve(SLIPFIT), [...typed, "--json", "--quiet"], { cwd: "testdata" }));
  const found = difference(JSON.parse(fs.readFileSync(file, "utf8")), expected);
  assert.deepEqual(found.faults, []);
  assert.ok(found.worst <= kTolerance, `${found.place} differs by ${found.worst}`);
  await page.locator("#elsewhere").scrollIntoViewIfNeeded();
  await page.fill("#speed-slider", "20");
  await page.waitForFunction(() => document.getElementById("speed-words").textContent.startsWith("25.119"));
  await page.waitForTimeout(300);
  await picture();
  await reportOf(page).locator("#trace-section").scrollIntoViewIfNeeded();
  await picture();
  await page.locator("#save").scrollIntoViewIfNeeded();
  await saved(page, "project");
  await picture();
  assert.equal(step, 10);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("it saves all, and opens its project again", { skip }, async () => {
  const page = await open();
  await openDemo(page);
  await page.fill("#option-speed", "10");
  await page.keyboard.press("Tab");
  await page.focus("#window-begin");
  await page.keyboard.press("PageUp");
  await fit(page);
  const zip = await saved(page, "zip");
  const listed = execFileSync("python3", ["-c", "import sys,zipfile; z=zipfile.ZipFile(sys.argv[1]); assert z.testzip() is None; print(*z.namelist())", zip.file]);
  assert.equal(listed.toString().trim(), "demo.html demo.json demo-cycles.csv demo-curve.csv");
  await page.check("#comma");
  const cycles = await saved(page, "cycles");
  assert.match(fs.readFileSync(cycles.file, "utf8"), /^[^,]*;[^]*\d,\d/);
  const project = await saved(page, "project");
  const copy = path.join(SHOTS, project.name);
  fs.copyFileSync(project.file, copy);
  const command = await page.locator("#command").textContent();
  const again = await open();
  await openDemo(again, copy);
  assert.equal(await again.locator("#command").textContent(), command);
  assert.deepEqual([...page.faults, ...again.faults], []);
  await page.close();
  await again.close();
});

test("several files: a sweep and a comparison", { skip }, async () => {
  const page = await open();
  simulate("slow.csv", ["--speed", "10mm/s", "--duration", "2s"]);
  simulate("fast.csv", ["--speed", "20mm/s", "--duration", "2s"]);
  await openDemo(page, [path.join(SHOTS, "slow.csv"), path.join(SHOTS, "fast.csv")]);
  for (const [i, speed] of [10, 20].entries()) await page.locator("#files tbody input").nth(i).fill(String(speed));
  await page.check("input[value=sweep]");
  assert.equal(await page.locator("#command").textContent(), 'slipfit fit --joint slow.csv fast.csv --speed "10 mm/s" --speed "20 mm/s"');
  await fit(page);
  assert.equal(await page.locator("#trouble").isHidden(), true, await page.locator("#trouble").textContent());
  assert.equal(JSON.parse(fs.readFileSync((await saved(page, "document")).file, "utf8")).recordings.length, 2);
  await page.check("input[value=compare]");
  await fit(page);
  assert.equal(await page.locator("#trouble").isHidden(), true, await page.locator("#trouble").textContent());
  assert.equal(JSON.parse(fs.readFileSync((await saved(page, "document")).file, "utf8")).schema, "slipfit.compare/1");
  await page.screenshot({ path: shot("several") });
  assert.deepEqual(page.faults, []);
  await page.close();
});

const simulate = (name, options) => {
  const file = path.join(SHOTS, name);
  execFileSync(SLIPFIT, ["simulate", "--stiffness", "5000", "--natural-frequency", "900", "--damping-ratio", "0.05", "--static-friction", "4.2",
    "--kinetic-friction", "3.2", "--sample-rate", "5kHz", "--noise", "0.02", "--jitter", "0.05", ...options, "--out", file, "--quiet"]);
  return file;
};

test("once it has opened, no task of the page takes half as long as opening it", { skip: skip || (isFirefox && "tasks are measured in Chromium") }, async (context) => {
  const file = simulate("long.csv", ["--speed", "10mm/s", "--duration", "40s"]);
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  await browser.startTracing(page, { categories: ["toplevel", "v8", "blink.user_timing", "__metadata"] });
  await page.goto(pathToFileURL(WEB_PAGE).href);
  await page.evaluate(() => performance.mark("opened"));
  await openDemo(page, file);
  await page.fill("#option-speed", "10");
  await page.keyboard.press("Tab");
  await idle(page);
  await fit(page);
  await page.fill("#speed-slider", "20");
  await page.click("[data-zoom='0.5']");
  await page.waitForTimeout(500);
  const { traceEvents } = JSON.parse(await browser.stopTracing());
  const mains = new Set(traceEvents.filter((event) => event.args?.name === "CrRendererMain").map((event) => `${event.pid}:${event.tid}`));
  // Time on the processor, not on the wall: what other programs take is none of the page's.
  const ofPage = traceEvents.filter((event) => event.tdur && mains.has(`${event.pid}:${event.tid}`));
  // The page has no modules: those are the test's own.
  const modules = ofPage.filter((event) => event.name === "v8.evaluateModule");
  const isOfTest = (task) => modules.some((module) => module.tid === task.tid && module.ts >= task.ts && module.ts < task.ts + task.dur);
  const tasks = ofPage.filter((event) => event.name.endsWith("RunTask") && !isOfTest(event));
  // A ratio of two times of one run does not depend on the machine. A fit in the thread of the page would take longer than opening it.
  const opened = traceEvents.find((event) => event.name === "opened").ts;
  const times_ms = (isWanted) => tasks.filter(isWanted).map((task) => task.tdur / 1000);
  const opening = times_ms((task) => task.ts < opened).reduce((sum, ms) => sum + ms, 0);
  const longest = Math.max(...times_ms((task) => task.ts > opened));
  context.diagnostic(`${tasks.length} tasks, the longest takes ${longest.toFixed(0)} ms of processor time, opening the page ${opening.toFixed(0)} ms`);
  assert.ok(tasks.length > 100);
  assert.ok(longest < 0.5 * opening, `a task takes ${longest} ms, opening the page ${opening} ms`);
  await page.close();
});

test("a folder becomes a table, a line a recording", { skip }, async () => {
  const folder = path.join(SHOTS, "folder");
  fs.rmSync(folder, { recursive: true, force: true });
  fs.mkdirSync(path.join(folder, "inner"), { recursive: true });
  fs.copyFileSync(demo, path.join(folder, "run1.csv"));
  fs.copyFileSync(simulate("run2.csv", ["--speed", "20mm/s", "--duration", "2s"]), path.join(folder, "inner", "run2.csv"));
  fs.writeFileSync(path.join(folder, "notes.txt"), "no numbers here\n");
  fs.writeFileSync(path.join(folder, ".hidden.csv"), "1,2\n");
  const page = await open();
  if (isFirefox) { // Playwright chooses no folders in Debian's
    await page.setInputFiles("#file", ["run1.csv", "inner/run2.csv", "notes.txt"].map((name) => path.join(folder, name)));
    await page.check("input[value=each]");
  } else {
    await page.setInputFiles("#folder", folder);
  }
  await page.waitForFunction(() => document.querySelectorAll("#files tbody tr").length === 3);
  await idle(page);
  assert.equal(await page.locator("input[name=mode][value=each]").isChecked(), true);
  await page.fill("#option-speed", "10");
  const rows = page.locator("#files tbody tr");
  await rows.filter({ hasText: "run2.csv" }).locator("input").fill("20");
  await page.keyboard.press("Tab");
  await fit(page);
  const line = async (name) => (await page.locator("#each tbody tr").filter({ hasText: name }).locator("td").allTextContents());
  assert.deepEqual((await line("run1.csv")).slice(0, 3), ["stick slip", "10", "24.57"]);
  assert.deepEqual((await line("run2.csv")).slice(0, 2), ["stick slip", "20"]);
  assert.match((await line("notes.txt")).at(-1), /no rows of numbers/);
  await page.locator("#each").scrollIntoViewIfNeeded();
  await page.screenshot({ path: shot("folder") });
  assert.deepEqual(page.faults, []);
  await page.close();
});

/** The demo with an outlier and without 300 rows. */
function withGap() {
  const lines = fs.readFileSync(demo, "utf8").split("\n");
  const [time] = lines[5000].split(",");
  lines[5000] = `${time},20`;
  const file = path.join(SHOTS, "gaps.csv");
  fs.writeFileSync(file, [...lines.slice(0, 7000), ...lines.slice(7300)].join("\n"));
  return file;
}

test("gaps and outliers show on the trace", { skip }, async () => {
  const page = await open();
  await openDemo(page, withGap());
  assert.equal(await page.locator("#key-gaps").isVisible(), true);
  assert.equal(await page.locator("#key-outliers").isVisible(), true);
  assert.match(await page.locator("#facts").textContent(), /1 outliers; 1 gaps/);
  await page.locator("#trace-part").scrollIntoViewIfNeeded();
  await page.screenshot({ path: shot("gaps") });
  await openDemo(page);
  assert.equal(await page.locator("#key-gaps").isVisible(), false);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("a workbook and a file of MATLAB are read", { skip }, async () => {
  const page = await open();
  for (const [script, name] of [["workbook.py", "book.xlsx"], ["matlab.py", "run.mat"]]) {
    const file = path.join(SHOTS, name);
    execFileSync("python3", [`tests/web/${script}`, demo, file]);
    await openDemo(page, file);
    await page.fill("#option-speed", "10");
    await page.keyboard.press("Tab");
    await fit(page);
    assert.match(await reportOf(page).locator(".headline").textContent(), /Stick-slip at 24\.57/);
  }
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("a fit is stopped, and the page goes on", { skip }, async () => {
  const page = await open();
  await page.click("#example");
  await page.waitForSelector("#trace canvas");
  await idle(page);
  await page.evaluate(() => {
    document.getElementById("fit").click();
    setTimeout(() => document.getElementById("stop").click(), 20);
  });
  await page.waitForFunction(() => document.getElementById("progress").textContent === "stopped");
  await fit(page);
  assert.match(await reportOf(page).locator(".headline").textContent(), /stick-slip/i);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("pasted tables, decimal commas, refusals, hostile names", { skip }, async () => {
  const page = await open();
  const rows = fs.readFileSync(demo, "utf8").split("\n").slice(2, 4000).map((line) => line.replaceAll(".", "#").replaceAll(",", "\t").replaceAll("#", ","));
  await page.click("#paste");
  await page.locator("#pasted").evaluate((area, text) => { area.value = text; }, rows.join("\n"));
  await page.click("#take-paste");
  await page.waitForSelector("#trace canvas");
  await idle(page);
  await page.fill("#option-speed", "0,01");
  await page.selectOption("#options label:has(#option-speed) select", "m/s");
  assert.match(await page.locator("#command").textContent(), /"0\.01 m\/s"/);
  await fit(page);
  assert.match(await reportOf(page).locator(".headline").textContent(), /stick-slip/i);
  const hostile = path.join(SHOTS, "<img src=x onerror=alert(1)>.csv");
  fs.writeFileSync(hostile, "no numbers here\n");
  await page.setInputFiles("#file", hostile);
  await page.waitForFunction(() => !document.getElementById("trouble").hidden);
  assert.match(await page.locator("#trouble").textContent(), /no rows of numbers/);
  assert.equal(await page.evaluate(() => fetch("https://example.org/").then(() => "sent", () => "refused")), "refused");
  page.faults = page.faults.filter((fault) => !/example\.org/.test(fault)); // the refusal itself is told on the console
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("narrow, dark and German", { skip }, async () => {
  const page = await open(undefined, { viewport: { width: 400, height: 800 }, colorScheme: "dark", locale: "de-DE" });
  assert.equal(await page.locator("#choose").textContent(), "Dateien wählen");
  await openDemo(page);
  await page.fill("#option-speed", "10");
  await page.keyboard.press("Tab");
  assert.equal(await page.locator("#trace .trace-label").textContent(), "friction force [N]", "the trace is labelled as in the report");
  await page.screenshot({ path: shot("400-dark-german"), fullPage: true });
  await fit(page);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.ok(overflow <= 0, `wider than the screen by ${overflow} px`);
  assert.match(await reportOf(page).locator(".headline").textContent(), /^Stick-slip at 24\.57/, "the report is English");
  await page.screenshot({ path: shot("400-dark-result"), fullPage: true });
  await page.setViewportSize({ width: 1280, height: 900 });
  await openDemo(page, withGap());
  await fit(page);
  const warning = reportOf(page).locator(".warnings li").filter({ hasText: "zeitliche Lücken" });
  assert.match(await warning.innerText(), /^Die Aufzeichnung hat zeitliche Lücken\.\n.*gaps$/);
  const dark = await open(undefined, { colorScheme: "dark" });
  await openDemo(dark);
  await dark.fill("#option-speed", "10");
  await fit(dark);
  await dark.screenshot({ path: shot("dark"), fullPage: true });
  assert.deepEqual([...page.faults, ...dark.faults], []);
  await page.close();
  await dark.close();
});

test("every recording, from a static server", { skip }, async (context) => {
  const page = await open(`http://127.0.0.1:${server.address().port}/slipfit.html`);
  await page.setInputFiles("#file", demo);
  const found = tally();
  for (const { file, options } of recordings()) {
    await page.setInputFiles("#surface-file", file);
    const text = await page.evaluate(async (given) => {
      const blob = document.getElementById("surface-file").files[0];
      const result = await engine.call({ command: "fit", files: [{ name: blob.name, blob }], options: given });
      return result.outputs.document ?? JSON.stringify({ error: result.error });
    }, options);
    const one = await against(JSON.parse(text), "fit", file, options);
    assert.deepEqual(one.faults, [], `${file} ${words(options)}`);
    found.add(one);
  }
  context.diagnostic(found.text());
  assert.deepEqual(page.faults, []);
  await page.close();
});
