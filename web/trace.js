// The trace of the open recording, and the window of the fit above it; drawn by src/report/html/trace.js.
/** What a report's page holds for its own trace, or null. */
function traceDataIn(report = "") {
  const opening = '<script type="application/json" id="trace-data">';
  const begin = report.indexOf(opening) + opening.length;
  return begin < opening.length ? null : JSON.parse(report.slice(begin, report.indexOf("</script>", begin)));
}

function makeTrace(onWindow) {
  "use strict";
  const box = document.getElementById("trace");
  const handles = [document.getElementById("window-begin"), document.getElementById("window-end")];
  let data = null;
  let view = null;
  let range = null; // of the window, or none

  /** A ring around each outlier, of as many as can be told apart. */
  function drawOutliers(context, x, y, shown) {
    context.strokeStyle = getComputedStyle(document.documentElement).getPropertyValue("--chart-vermillion").trim();
    context.lineWidth = 1.5;
    const inSight = data.outliers.filter((time) => time >= shown[0] && time <= shown[1]).slice(0, 500);
    for (const time of inSight) {
      const next = Math.min(data.sampleAt(time), data.count - 1); // the packed time is rounded
      const isBefore = next > 0 && time - data.time(next - 1) < data.time(next) - time;
      context.beginPath();
      context.arc(x(time), y(data.force(isBefore ? next - 1 : next)), 5, 0, 2 * Math.PI);
      context.stroke();
    }
  }
  function behind(context, area, x, y, shown) {
    const bars = (times, look) => drawTraceBars(context, times, shown, x, { y: area.y, h: area.h, ...look });
    bars(data.slips, { y: area.y + area.h - 7, h: 7, colour: "--chart-sky" });
    bars(data.gaps, { colour: "--chart-orange", alpha: 0.3 });
    drawOutliers(context, x, y, shown);
    bars(data.sliding.flat(), { h: 4, colour: "--chart-green" });
    if (range) bars([shown[0], range[0], range[1], shown[1]], { colour: "--chart-axes", alpha: 0.14, widerThan: 1e-9 });
  }
  function placeHandles() {
    const ends = range ?? view.whole;
    const area = view.area();
    handles.forEach((handle, i) => {
      const x = view.xOf(ends[i]);
      handle.hidden = x < area.x - 1 || x > area.x + area.w + 1;
      handle.style.left = `${x}px`;
      handle.setAttribute("aria-valuemin", view.whole[0]);
      handle.setAttribute("aria-valuemax", view.whole[1]);
      handle.setAttribute("aria-valuenow", ends[i].toPrecision(6));
      handle.setAttribute("aria-valuetext", `${ends[i].toPrecision(6)} s`);
    });
  }
  function setRange(wanted) {
    const all = view.whole;
    range = wanted && [Math.max(all[0], Math.min(...wanted)), Math.min(all[1], Math.max(...wanted))];
    const isWhole = range && range[0] <= all[0] && range[1] >= all[1];
    if (isWhole || (range && !(range[1] - range[0] > 2 * data.step))) range = null;
    view.redraw();
    placeHandles();
    onWindow(range);
  }
  function moveEnd(i, time) {
    const ends = (range ?? view.whole).slice();
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
      if (handle.hasPointerCapture(event.pointerId)) moveEnd(i, view.timeOf(event.clientX - box.getBoundingClientRect().left));
    });
    handle.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: -0.01, ArrowRight: 0.01, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1 };
      if (!(event.key in steps)) return;
      const shown = view.shown();
      moveEnd(i, (range ?? view.whole)[i] + steps[event.key] * (shown[1] - shown[0]));
      event.preventDefault();
    });
  });

  return {
    /** packed: of a report's page; sliding: [[begin, end], ..] in seconds. */
    open(packed, sliding) {
      view?.close();
      data = { ...unpackTrace(packed), sliding };
      range = null;
      const chart = { box, label: data.label, behind, lines: [{ colour: "--chart-grey", at: data.force }] };
      view = makeTraceView(data, [chart], { onShow: () => view && placeHandles(), timeLabel: "time [s]" });
      placeHandles();
      return data.slips.length / 2;
    },
    zoom: (factor) => (factor === 0 ? view.show(view.whole) : view.zoom(factor)),
    setRange,
    shown: () => view.shown(),
    repeat: () => view && placeHandles(),
  };
}
