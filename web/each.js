// Every open recording fitted by itself, one after the other, as a table: a line a recording, and nothing else is kept.
function makeEach(onChoose) {
  "use strict";
  const kColumns = [
    ["file", "File", "", (line) => line.name], ["status", "Status", "", (line) => line.status],
    ["speed", "Driving speed", "mm/s", (line) => scaled(line.speed, 1000)],
    ["frequency", "frequency", "Hz", (line) => line.frequency?.value_Hz],
    ["spacing", "spacing of the slips", "mm", (line) => scaled(line.spacing?.value, 1000)],
    ["stiffness", "stiffness", "N/m", (line) => line.parameters?.stiffness_N_per_m?.value],
    ["damping", "damping ratio", "", (line) => line.parameters?.damping_ratio?.value],
    ["warnings", "Warnings", "", (line) => line.warnings ?? line.message],
  ];
  const section = document.getElementById("each");
  let lines = [];

  const scaled = (value, factor) => (value == null ? null : factor * value);
  const shown = (value) => (typeof value === "number" ? String(Number(value.toPrecision(4))) : value ?? "");
  const title = ([key, words, unit]) => say(key, words) + (unit ? ` [${unit}]` : "");
  function lineOf(file, result) {
    if (result.error) return { name: file.name, status: say("refused", "not fitted"), message: result.error.message };
    const found = JSON.parse(result.outputs.document);
    return { name: file.name, status: kindWords(found.status), speed: found.recording.speed_m_per_s,
      frequency: found.frequency, spacing: found.derived?.pattern_spacing_m,
      parameters: found.parameters, warnings: (found.warnings ?? []).map((warning) => warning.code).join(", ") };
  }
  function draw() {
    const cell = (tag, text) => Object.assign(document.createElement(tag), { textContent: text });
    section.querySelector("thead tr").replaceChildren(...kColumns.map((column) => Object.assign(cell("th", title(column)), { scope: "col" })));
    section.querySelector("tbody").replaceChildren(...lines.map((line, i) => {
      const row = document.createElement("tr");
      const open = Object.assign(cell("button", line.name), { type: "button", className: "link" });
      open.addEventListener("click", () => onChoose(i));
      const head = Object.assign(document.createElement("th"), { scope: "row" });
      head.append(open);
      row.append(head, ...kColumns.slice(1).map(([, , , value]) => cell("td", shown(value(line)))));
      return row;
    }));
  }
  document.getElementById("each-save").addEventListener("click", () => {
    const quoted = (value) => (/[",\n]/.test(String(value ?? "")) ? `"${String(value).replaceAll('"', '""')}"` : String(value ?? ""));
    const rows = [kColumns.map(title), ...lines.map((line) => kColumns.map(([, , , value]) => value(line)))];
    const csv = rows.map((row) => row.map(quoted).join(",")).join("\n");
    download("recordings.csv", `${document.getElementById("comma").checked ? withDecimalComma(csv) : csv}\n`);
  });

  return {
    /** requests: one a file; ask: calls the engine. Rejects with "stopped" where it was; the lines so far stay. */
    async run(files, requests, ask) {
      lines = [];
      section.hidden = false;
      draw();
      for (const [i, request] of requests.entries()) {
        lines.push(lineOf(files[i], await ask(request, `${say("computing", "computing")} ${i + 1}/${requests.length}`)));
        draw();
      }
      section.scrollIntoView();
    },
    draw: () => lines.length > 0 && draw(),
  };
}
