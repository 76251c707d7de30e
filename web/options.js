// The choices about a recording: fields that a person fills become options of the command line, by their names there.
const kUnits = {
  speed: ["mm/s", "mm/min", "m/s", "m/min", "um/s", "rpm"], force: ["N", "mN", "kN", "gf", "kgf", "lbf"],
  time: ["s", "ms", "us", "min"], length: ["mm", "m", "in"], frequency: ["Hz", "kHz"], mass: ["g", "kg"],
};
/** Fields in the order of the page; `more`: folded away. */
const kFields = [
  { key: "speed", unit: "speed", words: "Driving speed" },
  { key: "normal-force", unit: "force", words: "Normal force" },
  { key: "time-column", column: true, words: "Time column" },
  { key: "force-column", column: true, words: "Force column" },
  { key: "time-unit", choice: ["", ...kUnits.time], words: "Unit of time" },
  { key: "force-unit", choice: ["", ...kUnits.force, "1"], words: "Unit of force" },
  { key: "zero", unit: "force", words: "Zero of the force" },
  { key: "force-view", choice: ["", "spring", "transmitted", "contact"], prefix: "view-", words: "Sensor measures" },
  { key: "step", steps: true, words: "Step" },
  { key: "strokes", choice: ["", "both", "positive", "negative", "segments"], prefix: "strokes-", words: "Strokes" },
  { key: "radius", unit: "length", words: "Radius (torque, rpm)", more: true },
  { key: "normal-force-column", column: true, words: "Column of normal force", more: true },
  { key: "speed-column", column: true, words: "Column of speed", more: true },
  { key: "speed-uncertainty", unit: "speed", words: "Uncertainty of speed", more: true },
  { key: "sample-rate", unit: "frequency", words: "Sampling rate", more: true },
  { key: "mass", unit: "mass", words: "Moving mass", more: true },
  { key: "sensor-average", unit: "time", words: "Averaging time", more: true },
  { key: "drift", choice: ["", "sensor", "friction"], prefix: "drift-", words: "Trend of the force level", more: true },
  { key: "sheet", words: "Sheet", more: true },
  { key: "variable", words: "Variable", more: true },
];
const kReading = ["time-column", "force-column", "time-unit", "force-unit", "step", "radius", "normal-force-column",
  "speed-column", "sample-rate", "sheet", "variable"]; // what `slipfit info` takes

const optionsForm = (() => {
  "use strict";
  const form = document.getElementById("options");
  const values = {}; // key -> { value, unit }
  let info = null;
  let changed = () => {};

  function element(tag, properties = {}, ...children) {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
  }
  function select(entries, value, take, label) {
    const made = element("select", { className: label ? "" : "only" },
      ...entries.map(([key, words]) => element("option", { value: key, textContent: words })));
    made.value = value;
    if (label) made.setAttribute("aria-label", label);
    made.addEventListener("change", () => take(made.value));
    return made;
  }
  function store(key, part, is_whole = true) {
    values[key] = { ...values[key], ...part };
    changed(key, is_whole);
  }
  function entriesOf(field) {
    const none = ["", say("automatic", "automatic")];
    if (field.column) {
      const name = (column) => `${column.index}: ${column.name ?? "?"}${column.unit ? ` [${column.unit}]` : ""}`;
      return [none, ...(info?.columns ?? []).map((column) => [String(column.index), name(column)])];
    }
    if (field.steps) {
      const span = ({ time_s }) => (time_s ? ` (${time_s.map((time) => Number(time.toPrecision(4))).join("-")} s)` : "");
      return [["", say("all", "all")], ...(info?.steps ?? []).map((step) => [String(step.step), `${step.step}${span(step)}`])];
    }
    const words = (choice) => (field.prefix ? say(field.prefix + choice, choice) : choice);
    return field.choice.map((choice) => {
      if (choice === "") return field.key === "strokes" ? ["", say("strokes-none", "do not split")] : none;
      return [choice, choice === "segments" ? say("segments", "sections of constant speed") : words(choice)];
    });
  }
  function control(field) {
    const value = values[field.key]?.value ?? "";
    const label = element("label", {}, element("span", { textContent: say(field.key, field.words) }));
    if (field.column || field.choice || field.steps) {
      label.append(select(entriesOf(field), value, (chosen) => store(field.key, { value: chosen })));
      return label;
    }
    const input = element("input", { value, id: `option-${field.key}`, inputMode: field.unit ? "decimal" : "text" });
    input.addEventListener("input", () => store(field.key, { value: input.value.trim() }, false));
    input.addEventListener("change", () => store(field.key, { value: input.value.trim() }));
    label.append(input);
    if (!field.unit) return label;
    const unit = values[field.key]?.unit ?? kUnits[field.unit][0];
    label.append(select(kUnits[field.unit].map((name) => [name, name]), unit, (chosen) => store(field.key, { unit: chosen }), `${field.words}: unit`));
    return label;
  }
  function draw() {
    const open = form.querySelector("details")?.open ?? false;
    const isShown = (field) => !field.steps || (info?.steps ?? []).length > 1 || values.step?.value;
    const of = (more) => kFields.filter((field) => Boolean(field.more) === more && isShown(field)).map(control);
    const rest = element("details", { open }, element("summary", { textContent: say("more", "More") }), element("div", {}, ...of(true)));
    form.replaceChildren(...of(false), rest);
  }
  form.addEventListener("submit", (event) => event.preventDefault());
  /** "0,5" and "10" with their unit, as the command line takes them. */
  const quantity = (value, unit) => (/[a-z%]/i.test(value) ? value : `${value} ${unit}`).replace(/^([+-]?\d+),(\d+)/, "$1.$2");

  return {
    draw,
    quantity,
    onChange(listener) { changed = listener; },
    setInfo(read) {
      info = read;
      draw();
    },
    set(given) {
      for (const key of Object.keys(values)) delete values[key];
      Object.assign(values, given);
      draw();
    },
    state: () => structuredClone(values),
    has: (key) => Boolean(values[key]?.value),
    /** By the names of the command line. */
    options(keys = null) {
      const options = {};
      for (const field of kFields) {
        const { value, unit } = values[field.key] ?? {};
        if (!value || (keys && !keys.includes(field.key))) continue;
        if (field.key === "strokes" && value === "segments") options.segments = true;
        else options[field.key] = field.unit ? quantity(value, unit ?? kUnits[field.unit][0]) : value;
      }
      return options;
    },
    markMissing(key, is_missing) {
      document.getElementById(`option-${key}`)?.classList.toggle("missing", is_missing);
    },
  };
})();
