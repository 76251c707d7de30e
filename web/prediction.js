// The slider below a fit: what the model says at another speed.
const prediction = (() => {
  "use strict";
  const at = (id) => document.getElementById(id);
  const short = (number) => String(Number(number.toPrecision(5)));
  let fitted = null; // { document, speed }
  let asking = false;

  const speedNow = () => fitted.speed * 10 ** (Number(at("speed-slider").value) / 50);
  function shown(quantity, factor, unit) {
    if (quantity?.value == null) return say("outside", "no slips");
    const ends = quantity.ci95 ? ` (${quantity.ci95.map((end) => (end === null ? "?" : short(factor * end))).join(" ... ")})` : "";
    return `${short(factor * quantity.value)} ${unit}${ends}`;
  }
  function draw(row) {
    const lines = [[say("regime", "kind of motion"), kindWords(row.regime)],
      [say("frequency", "frequency"), shown(row.frequency_Hz, 1, "Hz")], [say("period", "period"), shown(row.period_s, 1000, "ms")],
      [say("spacing", "spacing of the slips"), shown(row.periodic_displacement_m, 1000, "mm")]];
    at("predicted").replaceChildren(...lines.flatMap(([name, text]) => [
      Object.assign(document.createElement("dt"), { textContent: name }), Object.assign(document.createElement("dd"), { textContent: text })]));
  }
  async function ask() {
    const speed = speedNow();
    at("speed-words").textContent = `${short(1000 * speed)} mm/s`;
    if (asking) return;
    asking = true;
    const files = [{ name: "fit.json", blob: new Blob([fitted.document]) }];
    const result = await engine.call({ command: "predict", files, options: { speeds: String(speed) } }).catch(() => null);
    asking = false;
    at("elsewhere").hidden = !result || Boolean(result.error);
    if (at("elsewhere").hidden) return;
    draw(JSON.parse(result.outputs.document).rows[0]);
    if (speed !== speedNow()) await ask();
  }
  at("speed-slider").addEventListener("input", () => ask());

  return {
    /** text: of a fit document; hidden where it has no model. */
    async show(text) {
      const found = JSON.parse(text);
      fitted = { document: text, speed: found.recording?.speed_m_per_s ?? found.recordings?.[0]?.speed_m_per_s };
      const isPredicted = Boolean(fitted.speed && found.parameters);
      at("elsewhere").hidden = !isPredicted;
      at("speed-slider").value = 0;
      if (isPredicted) await ask();
    },
    again: () => fitted && !at("elsewhere").hidden && ask(),
  };
})();
