// The interactive trace: dygraphs draws, this file hands it as many points as the screen can show.
(function () {
  "use strict";
  const section = document.getElementById("trace-section");
  const text = document.getElementById("trace-data").textContent;
  if (!section || !text || typeof Dygraph === "undefined") return;

  const kMissing = 65535;  // of a packed value
  const kTicks = 4294967295;  // of a packed time
  const kColumns = 900;  // of the visible part: two points each
  const kColumnsAside = 150;  // of each part out of sight: for the overview below

  const packed = JSON.parse(text);
  function bytesOf(base64) {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);  // ten times as quick as Uint8Array.from
    return bytes.buffer;
  }
  const ticksToSeconds = (tick) => packed.first_s + (tick / kTicks) * (packed.last_s - packed.first_s);
  const force = unpack("force");
  const residual = packed.residual_levels ? unpack("residual") : null;
  const count = force.levels.length;
  const ticks = packed.ticks ? new Uint32Array(bytesOf(packed.ticks)) : null;
  const slips = new Uint32Array(bytesOf(packed.slips));  // begin, end, begin, end, ...
  const step = count > 1 ? (packed.last_s - packed.first_s) / (count - 1) : 1;

  function unpack(name) {
    const low = packed[`${name}_low`];
    return { levels: new Uint16Array(bytesOf(packed[`${name}_levels`])), low, scale: (packed[`${name}_high`] - low) / 65534 };
  }
  function valueAt(series, i) {
    return series.levels[i] === kMissing ? null : series.low + series.scale * series.levels[i];
  }
  function timeAt(i) {
    return ticks ? ticksToSeconds(ticks[i]) : packed.first_s + i * step;
  }
  /** The first sample at or after a time. */
  function sampleAt(time) {
    let low = 0;
    let high = count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (timeAt(middle) < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** Samples first to last - 1 as the lowest and highest of each column; `row` makes a row from a sample. */
  function addColumns(rows, series, first, last, columns, row) {
    if (last - first <= 2 * columns) {
      for (let i = first; i < last; ++i) rows.push(row(i));
      return;
    }
    const levels = series.levels;
    for (let column = 0; column < columns; ++column) {
      const begin = first + Math.floor((column * (last - first)) / columns);
      const end = first + Math.floor(((column + 1) * (last - first)) / columns);
      let lowest = -1;
      let highest = -1;
      for (let i = begin; i < end; ++i) {
        if (levels[i] === kMissing) continue;
        if (lowest < 0 || levels[i] < levels[lowest]) lowest = i;
        if (highest < 0 || levels[i] > levels[highest]) highest = i;
      }
      if (lowest < 0) {
        rows.push(row(begin));
        continue;
      }
      rows.push(row(Math.min(lowest, highest)));
      if (lowest !== highest) rows.push(row(Math.max(lowest, highest)));
    }
  }
  function rowsFor(series, range, row) {
    const first = Math.max(0, sampleAt(range[0]) - 1);
    const last = Math.min(count, sampleAt(range[1]) + 1);
    const rows = [];
    addColumns(rows, series, 0, first, kColumnsAside, row);
    addColumns(rows, series, first, last, kColumns, row);
    addColumns(rows, series, last, count, kColumnsAside, row);
    return rows;
  }
  const forceRow = residual
    ? (i) => {
        const measured = valueAt(force, i);
        const left = valueAt(residual, i);
        return [timeAt(i), measured, left === null ? null : measured - left];
      }
    : (i) => [timeAt(i), valueAt(force, i)];
  const residualRow = (i) => [timeAt(i), valueAt(residual, i)];

  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const whole = [timeAt(0), timeAt(count - 1)];
  let shown = whole.slice();
  let busy = false;
  const graphs = [];

  /** Where the body slips: a bar at the foot, and a pale band above it unless it were thinner than a pixel. */
  function drawSlips(context, area, graph) {
    const pixels = area.w / (shown[1] - shown[0]);
    context.fillStyle = colour("--chart-sky");
    for (let i = 0; i + 1 < slips.length; i += 2) {
      const begin = ticksToSeconds(slips[i]);
      const end = ticksToSeconds(slips[i + 1]);
      if (end < shown[0] || begin > shown[1]) continue;
      const x = graph.toDomXCoord(begin);
      const width = (end - begin) * pixels;
      context.globalAlpha = 0.28;
      if (width >= 1.5) context.fillRect(x, area.y, width, area.h);
      context.globalAlpha = 1;
      context.fillRect(x, area.y + area.h - 7, Math.max(1, width), 7);
    }
  }

  function show(range) {
    const width = Math.min(Math.max(range[1] - range[0], 4 * step), whole[1] - whole[0]);
    const begin = Math.min(Math.max(range[0], whole[0]), whole[1] - width);
    shown = [begin, begin + width];
    busy = true;
    graphs[0].updateOptions({ file: rowsFor(force, shown, forceRow), dateWindow: shown });
    if (graphs[1]) graphs[1].updateOptions({ file: rowsFor(residual, shown, residualRow), dateWindow: shown });
    busy = false;
    section.dataset.begin = shown[0];
    section.dataset.end = shown[1];
  }
  function onDraw(graph, isInitial) {
    if (busy || isInitial) return;
    const range = graph.xAxisRange();
    const moved = Math.abs(range[0] - shown[0]) + Math.abs(range[1] - shown[1]);
    if (moved > 1e-9 * (whole[1] - whole[0])) show(range);
  }
  function zoom(factor) {
    const middle = (shown[0] + shown[1]) / 2;
    const half = (factor * (shown[1] - shown[0])) / 2;
    show([middle - half, middle + half]);
  }
  function pan(share) {
    const move = share * (shown[1] - shown[0]);
    show([shown[0] + move, shown[1] + move]);
  }
  function showAll() {
    show(whole);
    for (const graph of graphs) graph.updateOptions({ valueRange: [null, null] });  // a drag upwards sets it
  }
  /** The next slip in a direction comes to the middle, with two or three periods around it. */
  function stepSlip(direction) {
    const number = slips.length / 2;
    if (number < 2) return;
    const middle = (shown[0] + shown[1]) / 2;
    const begins = Array.from({ length: number }, (_, i) => ticksToSeconds(slips[2 * i]));
    const period = (begins[number - 1] - begins[0]) / (number - 1);
    const ahead = begins.filter((time) => direction * (time - middle) > 1e-3 * period);
    if (ahead.length === 0) return;
    const target = direction > 0 ? ahead[0] : ahead[ahead.length - 1];
    const half = Math.min((shown[1] - shown[0]) / 2, 1.5 * period);
    show([target - half, target + half]);
  }

  const readoff = document.getElementById("trace-readoff");
  const digits = (value, unit) => (value === null ? "-" : `${Number(value.toPrecision(5))}${unit ? " " + unit : ""}`);
  function readOff(event, time) {
    const i = Math.min(count - 1, Math.max(0, sampleAt(time)));
    const [, measured, fitted] = forceRow(i);
    const parts = [["time", `${Number(timeAt(i).toPrecision(8))} s`], ["measured", digits(measured, packed.unit)]];
    if (residual) parts.push(["fit", digits(fitted, packed.unit)], ["residual", digits(valueAt(residual, i), packed.unit)]);
    readoff.replaceChildren();
    for (const [name, value] of parts) {
      const bold = document.createElement("b");
      bold.textContent = value;
      readoff.append(`${name} `, bold, "   ");
    }
    for (const graph of graphs) graph.setSelection(graph.numRows() ? nearestRow(graph, time) : false);
  }
  function nearestRow(graph, time) {
    let low = 0;
    let high = graph.numRows() - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (graph.getValue(middle, 0) < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }
  const hint = readoff.textContent;
  const leave = () => {
    readoff.textContent = hint;
    for (const graph of graphs) graph.clearSelection();
  };

  function looks() {
    return { axisLineColor: colour("--chart-axes"), gridLineColor: colour("--chart-grid") };
  }
  function forceColours() {
    return residual ? [colour("--chart-grey"), colour("--chart-vermillion")] : [colour("--chart-grey")];
  }
  const common = {
    legend: "never", drawCallback: onDraw, highlightCallback: readOff, unhighlightCallback: leave, labelsKMB: false,
    animatedZooms: false, interactionModel: Dygraph.defaultInteractionModel, strokeWidth: 1.2, highlightCircleSize: 3, axes: { y: { axisLabelWidth: 62, pixelsPerLabel: 24 } },
  };
  function build() {
    section.classList.add("is-live");
    graphs.push(new Dygraph(document.getElementById("trace-force"), rowsFor(force, whole, forceRow), {
      ...common, ...looks(), labels: residual ? ["time", "measured", "fit"] : ["time", "measured"],
      colors: forceColours(), ylabel: packed.label, xlabel: residual ? "" : "time [s]", underlayCallback: drawSlips,
      showRangeSelector: true, rangeSelectorHeight: 34, rangeSelectorPlotFillColor: "", dateWindow: whole,
      rangeSelectorPlotStrokeColor: colour("--chart-axes"),
    }));
    if (!residual) {
      document.getElementById("trace-residual").remove();
      return;
    }
    setTimeout(buildResidual);  // a task of its own, so that the page answers in between
  }
  function buildResidual() {
    graphs.push(new Dygraph(document.getElementById("trace-residual"), rowsFor(residual, shown, residualRow), {
      ...common, ...looks(), labels: ["time", "residual"], colors: [colour("--chart-blue")], strokeWidth: 1,
      ylabel: packed.residual_label, xlabel: "time [s]", dateWindow: shown,
    }));
  }
  build();
  section.dataset.begin = shown[0];
  section.dataset.end = shown[1];

  if (slips.length < 4) {
    for (const button of section.querySelectorAll("[data-do=previous], [data-do=next]")) button.remove();
  }
  const actions = {
    "in": () => zoom(0.5), out: () => zoom(2), left: () => pan(-0.25), right: () => pan(0.25), all: showAll,
    previous: () => stepSlip(-1), next: () => stepSlip(1),
  };
  for (const button of section.querySelectorAll("button[data-do]")) {
    button.addEventListener("click", actions[button.dataset.do]);
  }
  const keys = {
    ArrowLeft: "left", ArrowRight: "right", "+": "in", "=": "in", "-": "out", Home: "all", 0: "all", n: "next",
    p: "previous",
  };
  section.querySelector(".live").addEventListener("keydown", (event) => {
    const action = keys[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    actions[action]();
    event.preventDefault();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    graphs[0].updateOptions({ ...looks(), colors: forceColours() });
    if (graphs[1]) graphs[1].updateOptions({ ...looks(), colors: [colour("--chart-blue")] });
  });
})();
