// The page: open, check, choose a window, fit, save.
(function () {
  "use strict";
  const at = (id) => document.getElementById(id);
  const kProject = "slipfit.project/1";
  const kExample = { stiffness: 5000, "natural-frequency": 900, "damping-ratio": 0.05, "static-friction": 4.2, "kinetic-friction": 3.2,
    speed: "10mm/s", duration: "2s", "sample-rate": "5kHz", noise: 0.02, jitter: 0.05 };
  let files = []; // { name, blob, side, speed }
  let chosen = 0;
  let info = null;
  let range = null;
  let fitted = null; // { request, outputs }
  let turn = 0; // of what is read: an older answer is dropped
  const trace = makeTrace((wanted) => {
    range = wanted;
    at("window-words").textContent = wanted ? `${say("window-is", "window")} ${wanted.map(short).join(` ${say("to", "to")} `)} s` : "";
    showCommand();
  });

  const short = (number) => String(Number(number.toPrecision(5)));
  const current = () => files[chosen];
  const each = makeEach((i) => choose(i));
  const mode = () => (files.length > 1 ? document.querySelector("input[name=mode]:checked").value : "single");
  const show = (id, is_shown) => { at(id).hidden = !is_shown; };
  function tell(error) {
    at("trouble").textContent = error ? `${error.message}` : "";
    show("trouble", Boolean(error));
  }

  // ---- opening ----
  async function open(blobs) {
    const opened = [];
    for (const { name, blob } of blobs) {
      if (name.endsWith(".slipfit.json") && (await openProject(blob))) return;
      opened.push({ name, blob, side: files.length + opened.length === 0 ? "A" : "B", speed: "" });
    }
    if (opened.length === 0) return;
    chosen = files.length;
    files = [...files, ...opened];
    listFiles();
    await read();
  }
  /** Several at once: a table of all is what is wanted first. */
  async function openFolder(blobs) {
    document.querySelector("input[name=mode][value=each]").checked = blobs.length > 1;
    await open(blobs);
  }
  async function openProject(blob) {
    let project;
    try {
      project = JSON.parse(await blob.text());
    } catch {
      return false;
    }
    if (project.schema !== kProject) return false;
    files = project.files.map((file) => ({ ...file, blob: new Blob([bytesOfBase64(file.base64)]) }));
    chosen = project.chosen;
    for (const input of document.querySelectorAll("input[name=mode]")) input.checked = input.value === project.mode;
    optionsForm.set(project.options);
    listFiles();
    await read();
    if (project.window) trace.setRange(project.window);
    return true;
  }
  function listFiles() {
    drawFileList(files, chosen, { choose, change: showCommand, remove(i) {
      files.splice(i, 1);
      chosen = Math.max(0, Math.min(chosen, files.length - 1));
      listFiles();
      if (files.length > 0) read();
    } });
  }
  function choose(i) {
    chosen = i;
    listFiles();
    read();
  }

  // ---- reading ----
  const source = (file) => ({ name: file.name, blob: file.blob });
  async function ask(request, words) {
    const begin = performance.now();
    const tick = () => { at("progress").textContent = `${words}: ${short((performance.now() - begin) / 1000)} s`; };
    const timer = setInterval(tick, 200);
    at("stop").disabled = false;
    try {
      return await engine.call(request);
    } finally {
      clearInterval(timer);
      at("stop").disabled = true;
      at("progress").textContent = "";
    }
  }
  async function read() {
    const mine = ++turn;
    tell(null);
    show("run", true);
    show("understood", true);
    const file = current();
    const told = await ask({ command: "info", files: [source(file)], options: optionsForm.options(kReading) }, say("reading", "reading"));
    if (mine !== turn) return;
    info = told.error ? null : JSON.parse(told.outputs.document);
    optionsForm.setInfo(info);
    showFacts(null);
    if (told.error) {
      show("trace-part", false);
      return tell(told.error);
    }
    await preview(mine, file);
  }
  /** The trace and the stretch that slides come from an analysis; where slips are does not hang on the speed. */
  async function preview(mine, file) {
    const options = optionsForm.options();
    if (!options.speed && info.taken.speed_m_per_s === null) options.speed = "1 mm/s";
    if (options.strokes || options.segments) delete options.strokes, delete options.segments;
    const seen = await ask({ command: "analyze", files: [source(file)], options, outputs: ["document", "report"] }, say("reading", "reading"));
    if (mine !== turn) return;
    const packed = traceDataIn(seen.outputs.report);
    show("trace-part", Boolean(packed));
    if (packed) {
      const found = JSON.parse(seen.outputs.document);
      const kept = range;
      const slips = trace.open(packed, [found.recording.sliding_s].filter(Boolean));
      trace.setRange(kept);
      showFacts(found, slips);
      show("key-gaps", found.recording.quality.gaps > 0);
      show("key-outliers", found.recording.quality.impulses > 0);
    }
    const is_divided = optionsForm.has("strokes");
    if (seen.error && !is_divided) tell(info.refusal ? { message: info.refusal } : seen.error);
    showCommand();
  }
  function showFacts(found, slips = 0) {
    const parts = [];
    const add = (count, words) => { if (count) parts.push(`${count} ${words}`); };
    if (info) {
      parts.push(`${current().name}: ${info.rows} ${say("rows", "rows")}, ${info.columns.length} ${say("columns", "columns")}`);
      if (info.sample_rate_Hz) add(short(info.sample_rate_Hz), say("samples", "samples per second"));
      if (info.steps.length > 1) add(info.steps.length, say("steps", "steps"));
    }
    if (found) {
      const { sliding_s: slides, quality } = found.recording;
      if (slides) parts.push(`${say("slides", "slides from")} ${slides.map(short).join(` ${say("to", "to")} `)} s`);
      add(slips, say("counted", "slips found"));
      add(quality.impulses, say("impulses", "outliers"));
      add(quality.gaps, say("gaps", "gaps"));
      add(quality.clipped_samples, say("clipped", "clipped samples"));
    }
    at("facts").textContent = parts.join("; ");
    const sentences = found?.recording.assumed ?? info?.assumed ?? [];
    at("assumed").replaceChildren(...sentences.map((sentence) => Object.assign(document.createElement("li"), { textContent: sentence })));
    show("assumed-part", sentences.length > 0);
  }

  // ---- fitting ----
  function request(outputs) {
    const options = optionsForm.options();
    if (mode() === "single" || mode() === "each") {
      if (range && mode() === "single") options.window = range.map((time) => String(Number(time.toPrecision(9)))).join(":");
      const surface = at("surface-file")?.files[0];
      return { command: "fit", files: [source(current())], options, outputs, surface: surface && { name: surface.name, blob: surface } };
    }
    const stated = (file) => (file.speed ? optionsForm.quantity(file.speed, "mm/s") : options.speed);
    for (const single of ["mass", "step"]) delete options[single];
    if (mode() === "sweep") {
      if (files.some((file) => file.speed)) options.speed = files.map(stated);
      return { command: "fit", files: files.map(source), options, outputs };
    }
    const sides = ["A", "B"].map((side) => files.filter((file) => file.side === side));
    if (files.some((file) => file.speed)) options.speed = sides.map((side) => stated(side[0] ?? current()));
    return { command: "compare", files: sides.flat().map(source), sides: sides[0].length, options, outputs };
  }
  /** Of one of several recordings, fitted by itself; the window is of the chosen one alone. */
  function requestOf(file) {
    const options = { ...optionsForm.options(), ...(file.speed && { speed: optionsForm.quantity(file.speed, "mm/s") }) };
    return { command: "fit", files: [source(file)], options, outputs: ["document"] };
  }
  const commandWord = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `"${word.replaceAll('"', '\\"')}"`);
  /** As it would be typed; both Windows and others take double quotes. */
  function showCommand() {
    if (files.length === 0) return;
    at("command").parentElement.hidden = mode() === "each"; // one a file
    const asked = request([]);
    const words = commandWords(asked, asked.files.map((file) => file.name));
    at("command").textContent = words.map(commandWord).join(" ");
  }
  const needsSpeed = () => {
    const is_told = optionsForm.has("speed") || optionsForm.has("speed-column") || info?.taken.speed_m_per_s || files.every((file) => file.speed);
    return mode() === "single" && !is_told && !(info?.steps ?? []).some((step) => step.speed_m_per_s);
  };
  async function fit() {
    const is_missing = needsSpeed();
    optionsForm.markMissing("speed", is_missing);
    if (is_missing) {
      tell({ message: say("speed-missing", "The driving speed is missing: please fill it in.") });
      at("option-speed").focus();
      return;
    }
    tell(null);
    const asked = request(["document", "report"]);
    at("fit").disabled = true;
    const begin = performance.now();
    try {
      if (mode() === "each") return await each.run(files, files.map(requestOf), ask);
      const result = await ask(asked, say("computing", "computing"));
      if (result.error) return tell(result.error);
      fitted = { request: asked, outputs: result.outputs };
      at("progress").textContent = `${say("done", "done after")} ${short((performance.now() - begin) / 1000)} s`;
      await present();
    } catch (error) {
      at("progress").textContent = error.message === "stopped" ? say("stopped", "stopped") : "";
      if (error.message !== "stopped") tell(error);
    } finally {
      at("fit").disabled = false;
    }
  }
  async function present() {
    show("result", true);
    const page = at("page");
    const fitHeight = () => {
      const shown = page.contentDocument?.documentElement; // none while the next page replaces it
      if (shown) page.style.height = `${shown.scrollHeight + 4}px`;
    };
    await new Promise((done) => {
      page.onload = done;
      page.srcdoc = fitted.outputs.report;
    });
    if (document.documentElement.lang === "de") translateWarnings(page.contentDocument);
    fitHeight();
    new ResizeObserver(fitHeight).observe(page.contentDocument.body);
    for (const kind of ["cycles", "curve"]) document.querySelector(`[data-save=${kind}]`).hidden = mode() !== "single";
    await prediction.show(fitted.outputs.document);
    at("result").scrollIntoView({ behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth" });
  }
  // ---- saving ----
  async function project() {
    const kept = await Promise.all(files.map(async ({ name, blob, side, speed }) =>
      ({ name, side, speed, base64: base64Of(new Uint8Array(await blob.arrayBuffer())) })));
    return JSON.stringify({ schema: kProject, files: kept, chosen, mode: mode(), options: optionsForm.state(), window: range });
  }
  const save = makeSaving({ fitted: () => fitted, stem: () => current().name.replace(/\.[^.]*$/, ""), ask, project });

  // ---- what a person does ----
  const opened = (list) => open(Array.from(list, (file) => ({ name: file.name, blob: file })));
  at("choose").addEventListener("click", () => at("file").click());
  at("file").addEventListener("change", () => { opened(at("file").files); at("file").value = ""; });
  at("choose-folder").addEventListener("click", () => at("folder").click());
  at("folder").addEventListener("change", () => { openFolder(chosenFiles(at("folder").files)); at("folder").value = ""; });
  at("example").addEventListener("click", async () => {
    const made = await ask({ command: "simulate", options: kExample, outputs: ["text"] }, say("computing", "computing"));
    optionsForm.set({ speed: { value: "10", unit: "mm/s" } });
    await open([{ name: "example.csv", blob: new Blob([made.outputs.text]) }]);
  });
  at("paste").addEventListener("click", () => { show("paste-box", true); at("pasted").focus(); });
  at("take-paste").addEventListener("click", () => {
    const text = at("pasted").value;
    if (!text.trim()) return tell({ message: say("nothing", "There is nothing to paste: copy columns of a spreadsheet first.") });
    return open([{ name: "pasted.txt", blob: new Blob([text]) }]);
  });
  for (const kind of ["dragover", "dragleave", "drop"]) {
    document.addEventListener(kind, (event) => {
      event.preventDefault();
      at("drop").classList.toggle("over", kind === "dragover");
      if (kind === "drop") droppedFiles(event.dataTransfer).then((found) => (found.length > 1 ? openFolder(found) : open(found)));
    });
  }
  document.addEventListener("paste", (event) => {
    if (/^(INPUT|TEXTAREA)$/.test(event.target.tagName)) return;
    const text = event.clipboardData.getData("text");
    if (text.trim()) open([{ name: "pasted.txt", blob: new Blob([text]) }]);
  });
  optionsForm.onChange((key, is_whole) => {
    showCommand();
    if (key === "speed" && at("option-speed").classList.contains("missing")) {
      optionsForm.markMissing("speed", false);
      tell(null);
    }
    if (is_whole && [...kReading, "strokes", "zero"].includes(key) && files.length > 0) read();
  });
  for (const button of document.querySelectorAll("[data-zoom]")) button.addEventListener("click", () => trace.zoom(Number(button.dataset.zoom)));
  for (const button of document.querySelectorAll("[data-save]")) button.addEventListener("click", () => save(button.dataset.save).catch(tell));
  for (const input of document.querySelectorAll("input[name=mode]")) input.addEventListener("change", showCommand);
  at("window-shown").addEventListener("click", () => trace.setRange(trace.shown()));
  at("window-all").addEventListener("click", () => trace.setRange(null));
  at("fit").addEventListener("click", fit);
  at("stop").addEventListener("click", () => engine.stop());
  at("language").addEventListener("change", () => {
    setLanguage(at("language").value);
    optionsForm.draw();
    listFiles();
    each.draw();
    prediction.again();
    if (info) showFacts(null);
    if (fitted) present();
  });
  const language = (navigator.language ?? "en").startsWith("de") ? "de" : "en";
  at("language").value = language;
  setLanguage(language);
  optionsForm.draw();
  engine.ready().catch((error) => tell({ message: `${say("too-old", "This browser is too old: it lacks WebAssembly with exceptions. Chrome from 95, Firefox from 113, Safari from 16.4.")} (${error.message})` }));
})();
