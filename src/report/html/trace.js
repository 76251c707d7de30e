// Traces over one clock on canvases: on the page of a recording, and in the browser version above the window of the fit.

/** The samples that a page packs (trace_data.cpp): values in 65534 levels, times as parts of the duration. */
function unpackTrace(packed) {
  const kMissing = 65535;
  const kTicks = 4294967295;
  const duration = packed.last_s - packed.first_s;
  function bytes(base64) {
    const text = atob(base64);
    const decoded = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) decoded[i] = text.charCodeAt(i); // ten times as fast as Uint8Array.from
    return decoded.buffer;
  }
  const atTick = (tick) => packed.first_s + (tick / kTicks) * duration;
  const timesOf = (base64) => Array.from(new Uint32Array(bytes(base64)), atTick);
  function series(name) {
    if (!packed[`${name}_levels`]) return null;
    const levels = new Uint16Array(bytes(packed[`${name}_levels`]));
    const low = packed[`${name}_low`];
    const scale = (packed[`${name}_high`] - low) / 65534;
    return { count: levels.length, at: (i) => (levels[i] === kMissing ? NaN : low + scale * levels[i]) };
  }
  const force = series("force");
  const residual = series("residual");
  const count = force.count;
  const step = duration / Math.max(1, count - 1);
  const ticks = packed.ticks ? new Uint32Array(bytes(packed.ticks)) : null;
  const time = ticks ? (i) => atTick(ticks[i]) : (i) => packed.first_s + i * step;
  /** The first sample at or after a time; `count` after the last one. */
  function sampleAt(seconds) {
    let [low, high] = [0, count];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (time(middle) < seconds) low = middle + 1;
      else high = middle;
    }
    return low;
  }
  return { count, step, time, sampleAt, force: force.at, residual: residual?.at ?? null, label: packed.label, unit: packed.unit,
    residualLabel: packed.residual_label, slips: timesOf(packed.slips), gaps: timesOf(packed.gaps), outliers: timesOf(packed.outliers) };
}

/**
 * Draws `data` of unpackTrace. `charts`, from top to bottom: { box, label, lines: [{ colour, at }], behind(context, area, x, y) }, where
 * `at(i)` is the value at a sample and x, y give pixels. Drag zooms, with shift or a finger it moves; a double click shows all. The strip
 * below the first chart shows the whole recording. onShow(range) follows each change; onPoint(sample or null) follows the pointer.
 */
function makeTraceView(data, charts, { onShow = () => {}, onPoint = () => {}, timeLabel = "time [s]" } = {}) {
  const kLeft = 66; // pixels beside, above and below the axes
  const kRight = 12;
  const kTop = 6;
  const kValues = 20;
  const kLabel = 20;
  const kStrip = 40;
  const whole = [data.time(0), data.time(data.count - 1)];
  let shown = whole.slice();
  const pointers = new Map();
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  function ticksOf(low, high, most) {
    const raw = (high - low) / Math.max(1, most);
    const power = 10 ** Math.floor(Math.log10(raw));
    const parts = [0.5, 1, 2, 5, 10];
    const coarse = parts.findIndex((part) => part * power >= raw * (1 - 1e-9));
    const ticksAt = (step) => {
      const digits = Math.min(20, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
      const ticks = [];
      for (let k = Math.ceil(low / step); k * step <= high && ticks.length < 50; ++k) ticks.push([k * step, (k * step).toFixed(digits)]);
      return ticks;
    };
    const ticks = ticksAt(parts[coarse] * power);
    return ticks.length > 1 ? ticks : ticksAt(parts[coarse - 1] * power); // one value is no scale
  }
  /** The lowest and highest sample of each column, so that no peak is lost; the samples themselves where they are few. */
  function envelope(at, first, last, columns) {
    const points = [];
    if (last - first <= 2 * columns) {
      for (let i = first; i < last; ++i) points.push([data.time(i), at(i)]);
      return points;
    }
    for (let column = 0; column < columns; ++column) {
      const begin = first + Math.floor((column * (last - first)) / columns);
      const end = first + Math.floor(((column + 1) * (last - first)) / columns);
      let [lowest, highest] = [begin, begin];
      let [low, high] = [Infinity, -Infinity];
      for (let i = begin; i < end; ++i) {
        const value = at(i);
        if (value < low) [low, lowest] = [value, i];
        if (value > high) [high, highest] = [value, i];
      }
      const ends = lowest === highest ? [lowest] : [Math.min(lowest, highest), Math.max(lowest, highest)];
      for (const i of ends) points.push([data.time(i), at(i)]);
    }
    return points;
  }
  function spanOf(lines) {
    let [low, high] = [Infinity, -Infinity];
    for (const points of lines) for (const [, value] of points) [low, high] = [value < low ? value : low, value > high ? value : high];
    if (!(low <= high)) return [0, 1];
    const room = low < high ? 0.05 * (high - low) : 0.5 * Math.abs(low) || 1;
    return [low - room, high + room];
  }
  function stroke(context, points, x, y, style, width) {
    context.strokeStyle = style;
    context.lineWidth = width;
    context.beginPath();
    let down = false;
    for (const [time, value] of points) {
      if (value !== value) { // a gap
        down = false;
        continue;
      }
      if (down) context.lineTo(x(time), y(value));
      else context.moveTo(x(time), y(value));
      down = true;
    }
    context.stroke();
  }
  function areaOf(chart) {
    const below = chart.isLast ? kValues + kLabel : kValues;
    return { x: kLeft, y: kTop, w: Math.max(1, chart.box.clientWidth - kLeft - kRight),
      h: Math.max(1, chart.box.clientHeight - kTop - below - (chart.hasStrip ? kStrip : 0)) };
  }
  const scaleOf = ([low, high], from, length) => (value) => from + (length * (value - low)) / (high - low);
  function drawAxes(context, area, x, y, values, isLast) {
    context.font = "12px system-ui, sans-serif";
    context.lineWidth = 0.8;
    const line = (x1, y1, x2, y2) => { context.beginPath(); context.moveTo(x1, y1); context.lineTo(x2, y2); context.stroke(); };
    context.strokeStyle = colour("--chart-grid");
    context.fillStyle = colour("--ink");
    context.textAlign = "center";
    context.textBaseline = "top";
    for (const [value, text] of ticksOf(...shown, area.w / 80)) {
      line(x(value), area.y, x(value), area.y + area.h);
      context.fillText(text, Math.min(x(value), area.x + area.w + kRight - context.measureText(text).width / 2), area.y + area.h + 4);
    }
    if (isLast) context.fillText(timeLabel, area.x + area.w / 2, area.y + area.h + kValues + 2);
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const [value, text] of ticksOf(...values, area.h / 32)) {
      line(area.x, y(value), area.x + area.w, y(value));
      context.fillText(text, area.x - 5, y(value));
    }
    context.strokeStyle = colour("--chart-axes");
    context.strokeRect(area.x, area.y, area.w, area.h);
  }
  function drawStrip(context, chart, area) {
    const top = chart.box.clientHeight - kStrip + 6;
    const points = envelope(data.force, 0, data.count, Math.round(area.w));
    const x = scaleOf(whole, area.x, area.w);
    const y = scaleOf(spanOf([points]), top + kStrip - 8, 8 - kStrip);
    stroke(context, points, x, y, colour("--chart-axes"), 0.8);
    context.fillStyle = colour("--chart-grid");
    context.globalAlpha = 0.75;
    context.fillRect(area.x, top, x(shown[0]) - area.x, kStrip - 8);
    context.fillRect(x(shown[1]), top, area.x + area.w - x(shown[1]), kStrip - 8);
    context.globalAlpha = 1;
  }
  function draw(chart) {
    const { box, canvas } = chart;
    if (box.clientWidth === 0 || box.clientHeight === 0) return;
    const ratio = window.devicePixelRatio || 1;
    canvas.width = Math.round(box.clientWidth * ratio);
    canvas.height = Math.round(box.clientHeight * ratio);
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    const area = areaOf(chart);
    const first = Math.max(0, data.sampleAt(shown[0]) - 1);
    const last = Math.min(data.count, data.sampleAt(shown[1]) + 1);
    const lines = chart.lines.map((line) => envelope(line.at, first, last, Math.round(area.w)));
    const values = spanOf(lines);
    const x = scaleOf(shown, area.x, area.w);
    const y = scaleOf(values, area.y + area.h, -area.h);
    drawAxes(context, area, x, y, values, chart.isLast);
    context.save();
    context.beginPath();
    context.rect(area.x, area.y, area.w, area.h);
    context.clip();
    chart.behind?.(context, area, x, y, shown);
    lines.forEach((points, i) => stroke(context, points, x, y, colour(chart.lines[i].colour), 1.2));
    context.restore();
    if (chart.hasStrip) drawStrip(context, chart, area);
  }
  const redraw = () => charts.forEach(draw);

  function show(wanted) {
    const width = Math.min(Math.max(wanted[1] - wanted[0], 4 * data.step), whole[1] - whole[0]);
    const begin = Math.min(Math.max(wanted[0], whole[0]), whole[1] - width);
    shown = [begin, begin + width];
    redraw();
    onShow(shown);
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
  function element(box, name) {
    const made = document.createElement("div");
    made.className = name;
    made.hidden = true;
    box.append(made);
    return made;
  }
  function place(mark, begin, width) {
    mark.hidden = false;
    mark.style.left = `${begin}px`;
    mark.style.width = `${width}px`;
  }
  function listen(chart) {
    const { box } = chart;
    const hair = (chart.hair = element(box, "trace-hair"));
    const band = element(box, "trace-band");
    const xIn = (event) => event.clientX - box.getBoundingClientRect().left;
    const isInStrip = (event) => chart.hasStrip && event.clientY - box.getBoundingClientRect().top > box.clientHeight - kStrip;
    let drag = null; // { from, range, shown, moves }
    const timeOf = (x, range) => {
      const area = areaOf(chart);
      return range[0] + (Math.min(Math.max(x - area.x, 0), area.w) / area.w) * (range[1] - range[0]);
    };
    const distance = () => Math.abs([...pointers.values()][0] - [...pointers.values()][1]);
    box.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      box.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, xIn(event));
      drag = { from: xIn(event), range: isInStrip(event) ? whole : shown, shown, moves: event.shiftKey || event.pointerType === "touch" };
      if (pointers.size === 2) drag.pinch = distance();
    });
    box.addEventListener("pointermove", (event) => {
      const x = xIn(event);
      if (!drag) {
        const sample = Math.min(data.count - 1, data.sampleAt(timeOf(x, isInStrip(event) ? whole : shown)));
        for (const { hair: other } of charts) place(other, x, 1);
        hair.hidden = isInStrip(event);
        return onPoint(sample);
      }
      pointers.set(event.pointerId, x);
      if (drag.pinch) {
        const half = ((drag.shown[1] - drag.shown[0]) / 2) * (drag.pinch / Math.max(1, distance()));
        const middle = (drag.shown[0] + drag.shown[1]) / 2;
        return show([middle - half, middle + half]);
      }
      if (!drag.moves || drag.range === whole) return place(band, Math.min(x, drag.from), Math.abs(x - drag.from));
      const move = timeOf(drag.from, drag.shown) - timeOf(x, drag.shown);
      return show([drag.shown[0] + move, drag.shown[1] + move]);
    });
    box.addEventListener("pointerup", (event) => {
      const ended = drag;
      drag = null;
      band.hidden = true;
      pointers.delete(event.pointerId);
      if (!ended || ended.pinch || (ended.moves && ended.range !== whole)) return;
      const ends = [timeOf(ended.from, ended.range), timeOf(xIn(event), ended.range)];
      const half = (ended.shown[1] - ended.shown[0]) / 2;
      if (Math.abs(xIn(event) - ended.from) > 4) show([Math.min(...ends), Math.max(...ends)]);
      else if (ended.range === whole) show([ends[1] - half, ends[1] + half]);
    });
    box.addEventListener("pointercancel", (event) => {
      drag = null;
      band.hidden = true;
      pointers.delete(event.pointerId);
    });
    box.addEventListener("pointerleave", () => {
      for (const { hair: other } of charts) other.hidden = true;
      onPoint(null);
    });
    box.addEventListener("dblclick", (event) => { if (!isInStrip(event)) show(whole); });
  }
  const observer = new ResizeObserver(() => {
    redraw();
    onShow(shown);
  });
  charts.forEach((chart, i) => {
    chart.hasStrip = i === 0;
    chart.isLast = i === charts.length - 1;
    chart.box.classList.add("trace-box");
    chart.canvas = document.createElement("canvas");
    const label = document.createElement("div");
    label.className = "trace-label";
    label.textContent = chart.label;
    chart.box.replaceChildren(chart.canvas, label);
    listen(chart);
    draw(chart);
    observer.observe(chart.box);
  });
  const dark = matchMedia("(prefers-color-scheme: dark)");
  dark.addEventListener("change", redraw);

  return {
    show, zoom, pan, redraw, whole,
    shown: () => shown,
    area: () => areaOf(charts[0]),
    xOf: (time) => scaleOf(shown, areaOf(charts[0]).x, areaOf(charts[0]).w)(time),
    timeOf: (x) => shown[0] + ((x - areaOf(charts[0]).x) / areaOf(charts[0]).w) * (shown[1] - shown[0]),
    close() {
      observer.disconnect();
      dark.removeEventListener("change", redraw);
      for (const chart of charts) chart.box.replaceChildren();
    },
  };
}

/** Bars at the times begin, end, begin, end, ..., at least one pixel wide. */
function drawTraceBars(context, times, [first, last], x, { y, h, colour, alpha = 1, widerThan = 0 }) {
  context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(colour).trim();
  context.globalAlpha = alpha;
  for (let i = 0; i + 1 < times.length; i += 2) {
    if (times[i + 1] < first || times[i] > last) continue;
    const width = x(times[i + 1]) - x(times[i]);
    if (width >= widerThan) context.fillRect(x(times[i]), y, Math.max(1, width), h);
  }
  context.globalAlpha = 1;
}

// The page of a recording: the force with its fit, and the residual.
(function () {
  "use strict";
  const packed = document.getElementById("trace-data");
  if (!packed) return;
  const section = document.getElementById("trace-section");
  const data = unpackTrace(JSON.parse(packed.textContent));
  const { slips, residual } = data;
  const fit = residual && ((i) => data.force(i) - residual(i));
  const readoff = document.getElementById("trace-readoff");
  const hint = readoff.textContent;
  const words = (value) => (Number.isFinite(value) ? `${Number(value.toPrecision(5))}${data.unit ? " " + data.unit : ""}` : "-");

  function readOff(i) {
    if (i === null) {
      readoff.textContent = hint;
      return;
    }
    const parts = [["time", `${Number(data.time(i).toPrecision(8))} s`], ["measured", words(data.force(i))]];
    if (residual) parts.push(["fit", words(fit(i))], ["residual", words(residual(i))]);
    readoff.replaceChildren(...parts.flatMap(([name, value]) => {
      const bold = document.createElement("b");
      bold.textContent = value;
      return [`${name} `, bold, "   "];
    }));
  }
  /** Where the body slips: a bar at the foot, and a pale band above it unless it were thinner than a pixel. */
  function behind(context, area, x, y, shown) {
    drawTraceBars(context, slips, shown, x, { y: area.y, h: area.h, colour: "--chart-sky", alpha: 0.28, widerThan: 1.5 });
    drawTraceBars(context, slips, shown, x, { y: area.y + area.h - 7, h: 7, colour: "--chart-sky" });
  }
  section.classList.add("is-live");
  const boxes = [document.getElementById("trace-force"), document.getElementById("trace-residual")];
  if (!residual) boxes.pop().remove();
  const charts = [{ box: boxes[0], label: data.label, behind, lines: [{ colour: "--chart-grey", at: data.force }] }];
  if (residual) {
    charts[0].lines.push({ colour: "--chart-vermillion", at: fit });
    charts.push({ box: boxes[1], label: data.residualLabel, lines: [{ colour: "--chart-blue", at: residual }] });
  }
  const mark = (range) => { [section.dataset.begin, section.dataset.end] = range; };
  const view = makeTraceView(data, charts, { onShow: mark, onPoint: readOff });
  mark(view.shown());

  /** The next slip in a direction comes to the middle, with two or three periods around it. */
  function stepSlip(direction) {
    const begins = slips.filter((_, i) => i % 2 === 0);
    const shown = view.shown();
    const middle = (shown[0] + shown[1]) / 2;
    const period = (begins.at(-1) - begins[0]) / (begins.length - 1);
    const ahead = begins.filter((time) => direction * (time - middle) > 1e-3 * period);
    if (ahead.length === 0) return;
    const target = direction > 0 ? ahead[0] : ahead.at(-1);
    const half = Math.min((shown[1] - shown[0]) / 2, 1.5 * period);
    view.show([target - half, target + half]);
  }
  if (slips.length < 4) {
    for (const button of section.querySelectorAll("[data-do=previous], [data-do=next]")) button.remove();
  }
  const actions = {
    "in": () => view.zoom(0.5), out: () => view.zoom(2), left: () => view.pan(-0.25), right: () => view.pan(0.25),
    all: () => view.show(view.whole), previous: () => slips.length >= 4 && stepSlip(-1), next: () => slips.length >= 4 && stepSlip(1),
  };
  for (const button of section.querySelectorAll("button[data-do]")) button.addEventListener("click", actions[button.dataset.do]);
  const keys = {
    ArrowLeft: "left", ArrowRight: "right", "+": "in", "=": "in", "-": "out", Home: "all", 0: "all", n: "next", p: "previous",
  };
  section.querySelector(".live").addEventListener("keydown", (event) => {
    const action = keys[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    actions[action]();
    event.preventDefault();
  });
})();
