// Opens the site of scripts/docs.sh in a headless Chromium, from disk and from a static server, wide and narrow. Run by
// scripts/test-site.sh, which sets SITE (its folder), CHROMIUM (the browser), SHOTS (a folder for screenshots).
import assert from "node:assert/strict";
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const { SITE, CHROMIUM, SHOTS } = process.env;
const kinds = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".json": "application/json", ".svg": "image/svg+xml", ".png": "image/png" };
const written = fs.readdirSync(SITE, { recursive: true }).filter((file) => file.endsWith(".html") && file !== "404.html");
const pages = written.filter((file) => !file.startsWith("reference/cpp/"));
const ofDoxygen = ["index.html", "annotated.html", "files.html", "namespaceslipfit.html", "structslipfit_1_1Analysis.html"]
  .map((name) => `reference/cpp/${name}`);

let browser;
let server;
before(async () => {
  fs.mkdirSync(SHOTS, { recursive: true });
  browser = await chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox"] });
  server = http.createServer((request, response) => {
    const file = path.join(SITE, decodeURIComponent(new URL(request.url, "http://localhost").pathname));
    if (!fs.existsSync(file) || fs.statSync(file).isDirectory()) return response.writeHead(404).end();
    return response.writeHead(200, { "content-type": kinds[path.extname(file)] ?? "text/plain" }).end(fs.readFileSync(file));
  }).listen(0, "127.0.0.1");
  await new Promise((done) => server.on("listening", done));
});
after(async () => {
  await browser?.close();
  server?.close();
});

const fromDisk = (file) => pathToFileURL(path.join(SITE, file)).href;
const fromServer = (file) => `http://127.0.0.1:${server.address().port}/${file}`;

/** Opens pages and notes errors, and requests that leave the site. */
async function reader(width) {
  const page = await browser.newPage({ viewport: { width, height: 900 } });
  page.faults = [];
  page.on("pageerror", (error) => page.faults.push(`${page.url()}: ${error.message}`));
  page.on("console", (message) => message.type() === "error" && page.faults.push(`${page.url()}: ${message.text()}`));
  page.on("request", (request) => {
    const { protocol, hostname } = new URL(request.url());
    if (!["file:", "data:", "blob:", "about:"].includes(protocol) && hostname !== "127.0.0.1") page.faults.push(`asked for ${request.url()}`);
  });
  return page;
}

for (const width of [1280, 400]) {
  test(`every page opens from disk, ${width} wide`, async () => {
    const page = await reader(width);
    for (const file of [...pages, ...ofDoxygen]) {
      await page.goto(fromDisk(file));
      const { over, broken } = await page.evaluate(() => ({
        over: document.documentElement.scrollWidth - window.innerWidth,
        broken: [...document.images].filter((image) => image.complete && image.naturalWidth === 0).map((image) => image.src),
      }));
      assert.ok(over <= 0, `${file}: ${over} pixels wider than the window`);
      assert.deepEqual(broken, [], file);
      await page.screenshot({ path: path.join(SHOTS, `${file.replaceAll("/", "-").replace(".html", "")}-${width}.png`) });
    }
    assert.deepEqual(page.faults, []);
    await page.close();
  });
}

for (const [name, at] of [["disk", fromDisk], ["a static server", fromServer]]) {
  test(`search finds pages from ${name}`, async () => {
    const page = await reader(1280);
    await page.goto(at("howto/sweep.html"));
    await page.click("[data-md-component=search-query]");
    await page.keyboard.type("hysteresis");
    const first = page.locator(".md-search-result__item a").first();
    await first.waitFor({ timeout: 20_000 });
    await page.screenshot({ path: path.join(SHOTS, `search-${name.replaceAll(" ", "-")}.png`) });
    const target = await first.getAttribute("href");
    await first.click();
    await page.waitForURL((url) => !url.href.includes("sweep.html"));
    assert.match(await page.textContent("article"), /hysteres/i, target);
    assert.deepEqual(page.faults, []);
    await page.close();
  });
}
