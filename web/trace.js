// The trace of the open recording, drawn by dygraphs, and the window of the fit above it.
/** What a report's page holds for its own trace, or null. */
function traceDataIn(report = "") {
  const opening = '<script type="application/json" id="trace-data">';
  const begin = report.indexOf(opening) + opening.length;
  return begin < opening.length ? null : JSON.parse(report.slice(begin, report.indexOf("</script>", begin)));
}

function makeTrace(onWindow) {
  "use strict";
  const kColumns = 900; // of what is in sight: two points each
  const box = document.getElementById("trace");
  const handles = [document.getElementById("window-begin"), document.getElementById("window-end")];
  let data = null; // { time, force, slips, gaps, outliers, label, sliding }
  let graph = null;
  let shown = [0, 1];
  let range = null; // of the window, or none
  let busy = false;

  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const whole = () => [data.time(0), data.time(data.count - 1)];

  /** What the report's page packs: force in 65534 levels, times where the clock is uneven. */
  function unpack(packed) {
    const bytes = (base64) => bytesOfBase64(base64).buffer;
    const levels = new Uint16Array(bytes(packed.force_levels));
    const ticks = packed.ticks ? new Uint32Array(bytes(packed.ticks)) : null;
    const duration = packed.last_s - packed.first_s;
    const atTick = (tick) => packed.first_s + (tick / 4294967295) * duration;
    const timesOf = (base64) => Array.from(new Uint32Array(bytes(base64)), atTick);
    const scale = (packed.force_high - packed.force_low) / 65534;
    return {
      count: levels.length, levels, label: packed.label, step: duration / Math.max(1, levels.length - 1),
      slips: timesOf(packed.slips), gaps: timesOf(packed.gaps), outliers: timesOf(packed.outliers),
      force: (i) => (levels[i] === 65535 ? null : packed.force_low + scale * levels[i]),
      time: ticks ? (i) => atTick(ticks[i]) : (i) => packed.first_s + (i * duration) / Math.max(1, levels.length - 1),
    };
  }
  function sampleAt(time) {
    let low = 0;
    let high = data.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (data.time(middle) < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }
  /** The lowest and the highest of each column, so that no peak is lost. */
  function addRows(rows, first, last, columns) {
    const row = (i) => rows.push([data.time(i), data.force(i)]);
    if (last - first <= 2 * columns) {
      for (let i = first; i < last; ++i) row(i);
      return;
    }
    for (let column = 0; column < columns; ++column) {
      const begin = first + Math.floor((column * (last - first)) / columns);
      const end = first + Math.floor(((column + 1) * (last - first)) / columns);
      let [low, high] = [begin, begin];
      for (let i = begin; i < end; ++i) {
        if (data.levels[i] === 65535) continue;
        if (data.levels[low] === 65535 || data.levels[i] < data.levels[low]) low = i;
        if (data.levels[high] === 65535 || data.levels[i] > data.levels[high]) high = i;
      }
      row(Math.min(low, high));
      if (low !== high) row(Math.max(low, high));
    }
  }
  function rowsInSight() {
    const rows = [];
    const first = Math.max(0, sampleAt(shown[0]) - 1);
    const last = Math.min(data.count, sampleAt(shown[1]) + 1);
    addRows(rows, 0, first, 150);
    addRows(rows, first, last, kColumns);
    addRows(rows, last, data.count, 150);
    return rows;
  }

  function drawBehind(context, area, drawn) {
    const x = (time) => Math.min(Math.max(drawn.toDomXCoord(time), area.x), area.x + area.w);
    const bar = (begin, end, y, height, name) => {
      context.fillStyle = colour(name);
      if (end > shown[0] && begin < shown[1]) context.fillRect(x(begin), y, Math.max(1, x(end) - x(begin)), height);
    };
    for (let i = 0; i + 1 < data.slips.length; i += 2) bar(data.slips[i], data.slips[i + 1], area.y + area.h - 7, 7, "--chart-sky");
    context.globalAlpha = 0.3;
    for (let i = 0; i + 1 < data.gaps.length; i += 2) bar(data.gaps[i], data.gaps[i + 1], area.y, area.h, "--chart-orange");
    context.globalAlpha = 1;
    drawOutliers(context, drawn);
    for (const [begin, end] of data.sliding) bar(begin, end, area.y, 4, "--chart-green");
    if (!range) return;
    context.globalAlpha = 0.14;
    bar(shown[0], range[0], area.y, area.h, "--chart-axes");
    bar(range[1], shown[1], area.y, area.h, "--chart-axes");
    context.globalAlpha = 1;
  }
  /** A ring around each, of as many as can be told apart. */
  function drawOutliers(context, drawn) {
    context.strokeStyle = colour("--chart-vermillion");
    context.lineWidth = 1.5;
    const inSight = data.outliers.filter((time) => time >= shown[0] && time <= shown[1]).slice(0, 500);
    for (const time of inSight) {
      const [x, y] = drawn.toDomCoords(time, outlierForce(time));
      context.beginPath();
      context.arc(x, y, 5, 0, 2 * Math.PI);
      context.stroke();
    }
  }
  /** Of the sample nearest to the time, which is rounded. */
  function outlierForce(time) {
    const next = Math.min(sampleAt(time), data.count - 1);
    const isBefore = next > 0 && time - data.time(next - 1) < data.time(next) - time;
    return data.force(isBefore ? next - 1 : next);
  }
  function placeHandles() {
    const ends = range ?? whole();
    const area = graph.getArea();
    handles.forEach((handle, i) => {
      const x = graph.toDomXCoord(ends[i]);
      handle.hidden = x < area.x - 1 || x > area.x + area.w + 1;
      handle.style.left = `${x}px`;
      handle.setAttribute("aria-valuemin", whole()[0]);
      handle.setAttribute("aria-valuemax", whole()[1]);
      handle.setAttribute("aria-valuenow", ends[i].toPrecision(6));
      handle.setAttribute("aria-valuetext", `${ends[i].toPrecision(6)} s`);
    });
  }
  function show(wanted) {
    const all = whole();
    const width = Math.min(Math.max(wanted[1] - wanted[0], 4 * data.step), all[1] - all[0]);
    const begin = Math.min(Math.max(wanted[0], all[0]), all[1] - width);
    shown = [begin, begin + width];
    busy = true;
    graph.updateOptions({ file: rowsInSight(), dateWindow: shown });
    busy = false;
    placeHandles();
  }
  function onDraw(drawn, isInitial) {
    if (busy || isInitial) return;
    const now = drawn.xAxisRange();
    if (Math.abs(now[0] - shown[0]) + Math.abs(now[1] - shown[1]) > 1e-9 * (whole()[1] - whole()[0])) show(now);
  }
  function setRange(wanted) {
    const all = whole();
    range = wanted && [Math.max(all[0], Math.min(...wanted)), Math.min(all[1], Math.max(...wanted))];
    const isWhole = range && range[0] <= all[0] && range[1] >= all[1];
    if (isWhole || (range && !(range[1] - range[0] > 2 * data.step))) range = null;
    busy = true;
    graph.updateOptions({});
    busy = false;
    placeHandles();
    onWindow(range);
  }
  function moveEnd(i, time) {
    const ends = (range ?? whole()).slice();
    ends[i] = i === 0 ? Math.min(time, ends[1] - 4 * data.step) : Math.max(time, ends[0] + 4 * data.step);
    setRange(ends);
  }
  handles.forEach((handle, i) => {
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      event.preventDefault();
      handle.focus();
    });
    handle.addEventListener("pointermove", (event) => {
      if (handle.hasPointerCapture(event.pointerId)) moveEnd(i, graph.toDataXCoord(event.clientX - box.getBoundingClientRect().left));
    });
    handle.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: -0.01, ArrowRight: 0.01, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1 };
      if (!(event.key in steps)) return;
      moveEnd(i, (range ?? whole())[i] + steps[event.key] * (shown[1] - shown[0]));
      event.preventDefault();
    });
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => graph?.updateOptions(looks()));
  const looks = () => ({ axisLineColor: colour("--chart-axes"), gridLineColor: colour("--chart-grid"), colors: [colour("--chart-grey")] });

  const axisWords = (english) => (document.documentElement.lang === "de" ? germanOf(english) : null) ?? english;

  return {
    /** packed: of a report's page; sliding: [[begin, end], ..] in seconds. */
    open(packed, sliding) {
      data = { ...unpack(packed), sliding };
      graph?.destroy();
      shown = whole();
      range = null;
      graph = new Dygraph(box, rowsInSight(), { ...looks(), labels: ["time", "force"], ylabel: axisWords(data.label), xlabel: axisWords("time [s]"),
        legend: "never", drawCallback: onDraw, underlayCallback: drawBehind, labelsKMB: false, strokeWidth: 1.2,
        dateWindow: shown, axes: { y: { axisLabelWidth: 62, pixelsPerLabel: 24 } }, interactionModel: Dygraph.defaultInteractionModel });
      placeHandles();
      new ResizeObserver(() => placeHandles()).observe(box);
      return data.slips.length / 2;
    },
    zoom(factor) {
      const middle = (shown[0] + shown[1]) / 2;
      const half = (factor * (shown[1] - shown[0])) / 2;
      show(factor === 0 ? whole() : [middle - half, middle + half]);
    },
    setRange,
    shown: () => shown,
    repeat: () => graph && placeHandles(),
  };
}
