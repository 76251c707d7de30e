// Buttons on every page: a chart as SVG or PNG, its data as CSV, a table into the clipboard.
(function () {
  "use strict";
  const kScale = 2; // of a PNG: sharp on screens and in print
  const kStyles = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-opacity", "font-size", "font-family", "font-weight", "opacity"];

  function download(name, blob) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
  /** The picture with the colours that the page gives it. */
  function standalone(svg) {
    const copy = svg.cloneNode(true);
    const from = svg.querySelectorAll("*");
    copy.querySelectorAll("*").forEach((element, i) => {
      const style = getComputedStyle(from[i]);
      for (const name of kStyles) element.style.setProperty(name, style.getPropertyValue(name));
    });
    const box = svg.viewBox.baseVal;
    copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
    copy.setAttribute("width", box.width);
    copy.setAttribute("height", box.height);
    copy.style.background = getComputedStyle(document.body).backgroundColor;
    return new XMLSerializer().serializeToString(copy);
  }
  function savePicture(svg, name) {
    const box = svg.viewBox.baseVal;
    const image = new Image();
    image.onload = () => {
      const canvas = document.createElement("canvas");
      canvas.width = kScale * box.width;
      canvas.height = kScale * box.height;
      canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob((blob) => download(`${name}.png`, blob));
    };
    image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(standalone(svg))}`;
  }
  /** Pixels of a line or an area ("M12.3 45l.5-1.2 ...": a place, then steps), or of markers. */
  function pixelsOf(series) {
    if (series.localName === "g") return [...series.children].map((mark) => mark.getAttribute("transform").match(/[-\d.]+/g).map(Number));
    return series.getAttribute("d").split("M").slice(1).flatMap((part) => {
      const numbers = part.match(/-?\d*\.?\d+/g).map(Number);
      let [x, y] = [0, 0];
      return numbers.flatMap((_, i) => (i % 2 === 0 ? [[(x += numbers[i]), (y += numbers[i + 1])]] : []));
    });
  }
  /** From a pixel to the value of an axis: its ends, 1 if it is logarithmic, where it begins, and its length. */
  function axisOf(words) {
    const [low, high, isLogarithmic, begin, length] = words.split(" ").map(Number);
    return (pixel) => {
      const share = (pixel - begin) / length;
      return Number((isLogarithmic ? low * (high / low) ** share : low + share * (high - low)).toPrecision(5));
    };
  }
  /** The points of a chart as they are drawn, to a tenth of a pixel. */
  function csvOf(svg) {
    const quoted = (text) => `"${text.replaceAll('"', '""')}"`;
    const rows = [...svg.querySelectorAll(".panel")].flatMap((panel, i) => {
      const [x, y] = [axisOf(panel.dataset.x), axisOf(panel.dataset.y)];
      return [...panel.querySelectorAll("[data-name]")].flatMap((series) => {
        const name = quoted([series.dataset.name, panel.dataset.axes].filter(Boolean).join(", "));
        return pixelsOf(series).map((pixel) => `${i + 1},${name},${x(pixel[0])},${y(pixel[1])}\n`);
      });
    });
    return ["panel,series,x,y\n", ...rows].join("");
  }
  function button(words, label, act) {
    const element = document.createElement("button");
    element.type = "button";
    element.textContent = words;
    element.setAttribute("aria-label", label);
    element.addEventListener("click", () => act(element));
    return element;
  }
  function tools(...buttons) {
    const row = document.createElement("div");
    row.className = "tools save";
    row.append(...buttons);
    return row;
  }
  for (const figure of document.querySelectorAll("figure")) {
    const svg = figure.querySelector("svg.chart");
    if (!svg) continue;
    const name = svg.id || "chart";
    figure.append(tools(
      button("SVG", `Save the chart ${name} as SVG`, () => download(`${name}.svg`, new Blob([standalone(svg)], { type: "image/svg+xml" }))),
      button("PNG", `Save the chart ${name} as PNG`, () => savePicture(svg, name)),
      button("CSV", `Save the data of the chart ${name} as CSV`, () => download(`${name}.csv`, new Blob([csvOf(svg)], { type: "text/csv" }))),
    ));
  }
  /** Cells apart by tabs, as spreadsheets take them; the value before its interval. */
  function textOf(table) {
    const cell = (c) => (c.dataset.words || c.innerText || c.textContent).replace(/\s+/g, " ").trim();
    return [...table.rows].map((row) => [...row.cells].map(cell).join("\t")).join("\n");
  }
  function copied(text) {
    const area = document.createElement("textarea"); // also where a page may not use the clipboard
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  }
  for (const table of document.querySelectorAll(".wide > table")) {
    table.parentElement.after(tools(button("Copy table", "Copy the table into the clipboard", (pressed) => {
      pressed.textContent = copied(textOf(table)) ? "Copied" : "Cannot copy";
    })));
  }
})();
