// Sorts and filters the table of a batch.
(function () {
  "use strict";
  const table = document.getElementById("recordings");
  const body = table.tBodies[0];
  const rows = [...body.rows, ...document.getElementById("later").content.querySelectorAll("tr")];
  const wordsOf = new Map(rows.map((row) => [row, row.textContent.toLowerCase()]));
  const search = document.getElementById("search");
  const status = document.getElementById("status");
  const shown = document.getElementById("shown");
  const more = document.getElementById("more");
  const kAtOnce = 500;  // rows that are laid out: ten thousand make every key stroke slow
  let most = kAtOnce;

  function show() {
    const sought = search.value.toLowerCase();
    const fits = (row) => (!status.value || row.dataset.status === status.value) && wordsOf.get(row).includes(sought);
    const found = rows.filter(fits);
    body.replaceChildren(...found.slice(0, most));
    shown.textContent = `${found.length} of ${rows.length}`;
    more.hidden = found.length <= most;
    more.textContent = `Show ${Math.min(kAtOnce, found.length - most)} more`;
  }
  function showAnew() {
    most = kAtOnce;
    show();
  }

  /** Numbers by value, what is not known last in either direction; other cells by their text. */
  function compare(a, b, column, direction) {
    const left = a.cells[column];
    const right = b.cells[column];
    if (!("value" in left.dataset)) return direction * left.textContent.localeCompare(right.textContent, undefined, { numeric: true });
    if (left.dataset.value === "" || right.dataset.value === "") {
      return (left.dataset.value === "" ? 1 : 0) - (right.dataset.value === "" ? 1 : 0);
    }
    return direction * (Number(left.dataset.value) - Number(right.dataset.value));
  }
  for (const button of table.tHead.querySelectorAll("button")) {
    button.addEventListener("click", () => {
      const heading = button.closest("th");
      const rising = heading.getAttribute("aria-sort") !== "ascending";
      for (const other of table.tHead.querySelectorAll("th")) other.removeAttribute("aria-sort");
      heading.setAttribute("aria-sort", rising ? "ascending" : "descending");
      rows.sort((a, b) => compare(a, b, heading.cellIndex, rising ? 1 : -1));
      showAnew();
    });
  }
  search.addEventListener("input", showAnew);
  status.addEventListener("change", showAnew);
  more.addEventListener("click", () => {
    most += kAtOnce;
    show();
  });
  show();
})();
