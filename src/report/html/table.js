// Sorts and filters the table of a batch.
(function () {
  "use strict";
  const table = document.getElementById("recordings");
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const search = document.getElementById("search");
  const status = document.getElementById("status");
  const shown = document.getElementById("shown");

  function filter() {
    const words = search.value.toLowerCase();
    let count = 0;
    for (const row of rows) {
      const fits = (!status.value || row.dataset.status === status.value) && row.textContent.toLowerCase().includes(words);
      row.hidden = !fits;
      count += fits ? 1 : 0;
    }
    shown.textContent = `${count} of ${rows.length}`;
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
      body.append(...rows);
    });
  }
  search.addEventListener("input", filter);
  status.addEventListener("change", filter);
  filter();
})();
