// The table of open files: which is chosen, its speed and side. on: { choose(i), remove(i), change() }
function drawFileList(files, chosen, on) {
  "use strict";
  document.getElementById("many").hidden = files.length < 2;
  document.getElementById("files").tBodies[0].replaceChildren(...files.map((file, i) => {
    const row = document.createElement("tr");
    row.innerHTML = '<th scope="row"><button type="button"></button></th><td><input inputmode="decimal"> mm/s</td>' +
      '<td><select><option>A</option><option>B</option></select></td><td><button type="button"></button></td>';
    const [name, gone] = row.querySelectorAll("button");
    const [speed, side] = [row.querySelector("input"), row.querySelector("select")];
    row.setAttribute("aria-selected", i === chosen);
    name.textContent = file.name;
    name.addEventListener("click", () => on.choose(i));
    speed.value = file.speed;
    speed.setAttribute("aria-label", `${say("speed", "Driving speed")}: ${file.name}`);
    speed.addEventListener("change", () => { file.speed = speed.value.trim(); on.change(); });
    side.value = file.side;
    side.setAttribute("aria-label", `${say("side", "Side")}: ${file.name}`);
    side.addEventListener("change", () => { file.side = side.value; on.change(); });
    gone.textContent = say("remove", "remove");
    gone.setAttribute("aria-label", `${say("remove", "remove")}: ${file.name}`);
    gone.addEventListener("click", () => on.remove(i));
    return row;
  }));
}
