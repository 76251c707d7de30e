// The program over files in memory. `createSlipfit` is what emscripten wrote; everything here runs at once and blocks.
function makeSlipfit(wasm) {
  "use strict";
  const kOutputs = { document: "--out", text: "--out", report: "--report", cycles: "--cycles", curve: "--curve", csv: "--csv" };
  let core = null;
  let notices = [];

  /** A program in fresh memory: after one that ended where nothing ends it, and at the start. */
  function start() {
    core = {
      print: (line) => notices.push(line),
      printErr: (line) => notices.push(line.replace(/^slipfit: /, "")),
      instantiateWasm(imports, done) {
        const instance = new WebAssembly.Instance(wasm, imports);
        done(instance);
        return instance.exports;
      },
    };
    createSlipfit(core).catch(() => {});
    core.FS.mkdir("/recordings");
    core.FS.mkdir("/results");
    core.FS.chdir("/recordings");
  }
  function clear(folder) {
    for (const name of core.FS.readdir(folder)) {
      if (name !== "." && name !== "..") core.FS.unlink(`${folder}/${name}`);
    }
  }

  function bytesOf(content) {
    if (typeof content === "string") return new TextEncoder().encode(content);
    if (content instanceof ArrayBuffer) return new Uint8Array(content);
    if (ArrayBuffer.isView(content)) return new Uint8Array(content.buffer, content.byteOffset, content.byteLength);
    throw new Refusal("expected the bytes of a file: a Uint8Array, an ArrayBuffer or a text");
  }

  function optionsOf(options) {
    if (options === undefined || options === null || options === "") return {};
    let parsed = options;
    if (typeof options === "string") {
      try {
        parsed = JSON.parse(options);
      } catch {
        throw new Refusal('the options are no JSON; expected an object such as {"speed": "10 mm/s"}');
      }
    }
    if (typeof parsed !== "object" || parsed === null || Array.isArray(parsed)) {
      throw new Refusal('the options are no object; expected one such as {"speed": "10 mm/s"}');
    }
    return parsed;
  }
  const refusal = (message) => {
    const remedy = message.includes("; ") ? message.slice(message.lastIndexOf("; ") + 2) : null;
    return { exit_code: 2, error: { code: "wrong_usage", message, remedy, exit_code: 2 }, notices: [], outputs: {} };
  };
  const ended = (reason) => {
    const message = "not enough memory for this recording; use a window to take a part of it";
    const is_memory = /memory|allocat|abort/i.test(reason);
    return { exit_code: 3, notices, outputs: {}, error: {
      code: is_memory ? "out_of_memory" : "internal_error", exit_code: 3,
      message: is_memory ? message : `internal error (${reason}); please report it with the recording`,
      remedy: is_memory ? "use a window to take a part of it" : "please report it with the recording" } };
  };

  function call(words, outputs) {
    const file = (output) => `/results/${output}`;
    const is_text = outputs.includes("text");
    const written_to = new Set([is_text ? "text" : "document", ...outputs]);
    const added = ["--quiet", ...(is_text ? [] : ["--json"]), ...[...written_to].flatMap((output) => [kOutputs[output], file(output)])];
    const request = JSON.stringify({ words, outputs: added });
    const answer = JSON.parse(core.ccall("slipfit_run", "string", ["string"], [request]));
    const written = {};
    if (!answer.error) {
      for (const output of outputs) written[output] = core.FS.readFile(file(output), { encoding: "utf8" });
    }
    return { ...answer, notices, outputs: written };
  }

  /** Writes files under names that differ, and returns these. */
  function place(files) {
    const taken = new Set();
    return files.map(({ name, bytes }) => {
      let free = fileName(name);
      while (taken.has(free)) free = free.replace(/(\.[^.]*)?$/, "_$1");
      taken.add(free);
      core.FS.writeFile(free, bytesOf(bytes), { canOwn: true });
      return free;
    });
  }

  /**
   * One command over files in memory. files: [{ name, bytes }]; sides: how many of them are side A of a comparison; surface:
   * the file of a worn track; outputs: of document (JSON) or text, report, cycles, curve, csv.
   * Returns { exit_code, error, notices, outputs }; throws nothing.
   */
  function run({ command, files = [], sides, surface = null, options = {}, speeds, outputs = ["document"] }) {
    try {
      const given = { ...optionsOf(options), ...(speeds !== undefined && { speeds }) };
      if (!core) start();
      notices = [];
      const words = commandWords({ command, sides, options: given }, place(files));
      if (surface) words.push("--surface", place([{ ...surface, name: `surface-${fileName(surface.name).replace("./", "")}` }])[0]);
      return call(words, outputs);
    } catch (error) {
      if (error instanceof Refusal) return refusal(error.message);
      core = null;
      return ended(String(error?.message ?? error));
    } finally {
      if (core) {
        clear("/recordings");
        clear("/results");
      }
    }
  }

  /** The text of one output, or {"error": ...}. */
  function textOf(request) {
    const result = run(request);
    return result.error ? JSON.stringify({ error: result.error }) : result.outputs[(request.outputs ?? ["document"])[0]];
  }
  const ofOne = (command, output) => (bytes, name = "recording", options = "{}") =>
    textOf({ command, files: [{ bytes, name }], options, outputs: [output] });

  return {
    run,
    memoryBytes: () => core?.HEAP8.length ?? 0, // grows, and never shrinks
    fit: ofOne("fit", "document"),
    analyze: ofOne("analyze", "document"),
    info: ofOne("info", "document"),
    surface: ofOne("surface", "document"),
    report: ofOne("fit", "report"),
    cycles: ofOne("fit", "cycles"),
    curve: ofOne("fit", "curve"),
    predict: (fit, speeds, options = {}) => textOf({ command: "predict", files: [{ name: "fit.json", bytes: fit }], options, speeds }),
    sweep: (files, options = "{}") => textOf({ command: "fit", files, options }),
    compare: (a, b, options = "{}") => textOf({ command: "compare", files: [...a, ...b], sides: a.length, options }),
  };
}
