// A request as the words of a command line: where it runs, and where the page shows it.
class Refusal extends Error {}

const kOwnOptions = ["out", "report", "cycles", "curve", "plots", "csv", "json", "quiet", "joint", "surface", "help", "version"];

/** The last part of a path, as a word that no command takes for an option. */
function fileName(name) {
  const last = String(name ?? "").split(/[/\\]/).pop().replaceAll("\0", "");
  if (last === "" || last === "." || last === "..") return "recording";
  return last.startsWith("-") ? `./${last}` : last;
}

/** Options by the names of the command line, without dashes: { "normal-force": "5 N", strokes: true }. */
function optionWords(options) {
  const words = [];
  for (const [key, given] of Object.entries(options)) {
    const name = key.replaceAll("_", "-");
    if (!/^[a-z][a-z-]*$/.test(name) || kOwnOptions.includes(name)) {
      throw new Refusal(`there is no option '${key}'; expected a long option of the command line without its dashes`);
    }
    for (const value of Array.isArray(given) ? given : [given]) {
      if (value === null || value === undefined || value === false) continue;
      const text = String(value);
      if (value === true) words.push(`--${name}`);
      else if (name === "strokes" || text.startsWith("-")) words.push(`--${name}=${text}`);
      else words.push(`--${name}`, text);
    }
  }
  return words;
}

/** names: of the files; sides: so many of them, the first, are side A of a comparison. Several files of a fit are fitted together. */
function commandWords({ command, sides, options }, names) {
  const together = command === "fit" && names.length > 1 ? ["--joint", ...names] : names;
  const files = sides === undefined ? together : ["--a", ...names.slice(0, sides), "--b", ...names.slice(sides)];
  return ["slipfit", command, ...files, ...optionWords(options)];
}
