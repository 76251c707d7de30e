// What is saved of a fit: its outputs, all of them as an archive, or the project that opens again.
// of: { fitted(), stem(), ask(request, words), project() }
function makeSaving(of) {
  "use strict";
  const kEndings = { report: ".html", document: ".json", cycles: "-cycles.csv", curve: "-curve.csv" };

  const inChosenDecimals = (csv) => (document.getElementById("comma").checked ? withDecimalComma(csv) : csv);
  /** An output that was not asked for with the fit is made when it is wanted. */
  async function output(kind) {
    const fitted = of.fitted();
    if (fitted.outputs[kind] === undefined) {
      const result = await of.ask({ ...fitted.request, outputs: [kind] }, say("computing", "computing"));
      if (result.error) throw new Error(result.error.message);
      Object.assign(fitted.outputs, result.outputs);
    }
    return kind === "cycles" || kind === "curve" ? inChosenDecimals(fitted.outputs[kind]) : fitted.outputs[kind];
  }
  return async function save(kind) {
    const { request } = of.fitted();
    if (kind === "project") return download(`${of.stem()}.slipfit.json`, await of.project());
    if (kind !== "zip") return download(of.stem() + kEndings[kind], await output(kind));
    const kinds = request.command === "fit" && request.files.length === 1 ? Object.keys(kEndings) : ["report", "document"];
    const parts = [];
    for (const one of kinds) parts.push({ name: of.stem() + kEndings[one], text: await output(one) });
    return download(`${of.stem()}.zip`, zipOf(parts));
  };
}
