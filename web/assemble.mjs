// assemble.mjs BUILD: slipfit.mjs, slipfit.wasm and slipfit.html from what emscripten wrote into BUILD and the files here.
import fs from "node:fs";
import path from "node:path";
import zlib from "node:zlib";
import { fileURLToPath } from "node:url";

const build = process.argv[2];
const here = path.dirname(fileURLToPath(import.meta.url));
const read = (...names) => names.map((name) => fs.readFileSync(path.resolve(here, name), "utf8")).join("\n");
const made = (name) => path.resolve(build, name);
/** Text inside <script> or <style>: nothing in it may end the element. */
const inside = (text) => text.replace(/<\/(script|style)/g, "<\\/$1").replace(/\/\/[#@] sourceMappingURL=.*|\/\*# sourceMappingURL=.*?\*\//g, "");

const core = made("slipfit-core.js");
fs.copyFileSync(made("slipfit-core.wasm"), made("slipfit.wasm"));
fs.writeFileSync(made("slipfit.mjs"), read(core, "words.js", "api.js", "module.js"));

const parts = {
  style: inside(read("../src/report/html/style.css", "page.css")),
  engine: inside(read(core, "base64.js", "words.js", "api.js", "worker.js")),
  wasm: zlib.gzipSync(fs.readFileSync(made("slipfit.wasm")), { level: 9 }).toString("base64"),
  scripts: inside(read("words.js", "texts.js", "base64.js", "files.js", "engine.js", "options.js", "../src/report/html/trace.js", "trace.js", "folder.js", "file_list.js", "each.js", "prediction.js", "saving.js", "german_warnings.js", "page.js")),
};
const page = read("page.html").replace(/{{(\w+)}}/g, (_, name) => parts[name]);
fs.writeFileSync(made("slipfit.html"), page);
for (const name of ["slipfit.html", "slipfit.wasm", "slipfit.mjs"]) {
  const bytes = fs.readFileSync(made(name));
  console.log(`${name}: ${bytes.length} bytes, ${zlib.gzipSync(bytes, { level: 9 }).length} gzipped`);
}
