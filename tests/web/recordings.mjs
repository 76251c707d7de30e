// What the tests of the browser version compare: recordings with their options, and two documents of one recording.
import { execFile } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { promisify } from "node:util";

const kShared = "../shared/data";
// Of folders whose names of files do not tell it.
const kSpeeds = { clutch: "0.5 mm/s", giacomel: "10 um/s", guldstrand: "1.198 mm/s", umt: "10 mm/s" };
const kNames = [[/(\d+)mm_min/, "mm/min"], [/V-?(\d+)mmps/, "mm/s"], [/_v(\d+)\./, "um/s"]];

function realOptions(file) {
  const options = {};
  for (const [pattern, unit] of kNames) {
    const match = pattern.exec(path.basename(file));
    if (match && !options.speed) options.speed = `${match[1]} ${unit}`;
  }
  options.speed ??= kSpeeds[path.basename(path.dirname(file))];
  if (file.includes("guldstrand")) options["sample-rate"] = "4";
  return options.speed ? options : {};
}
function filesBelow(folder) {
  return fs.readdirSync(folder, { withFileTypes: true, recursive: true })
    .filter((entry) => entry.isFile()).map((entry) => path.join(entry.parentPath ?? entry.path, entry.name)).sort();
}
function synthetic() {
  const [names, ...rows] = fs.readFileSync(`${kShared}/synthetic/manifest.csv`, "utf8").trim().split(/\r?\n/).map((line) => line.split(","));
  return rows.map((cells) => Object.fromEntries(names.map((name, i) => [name, cells[i]])))
    .map((row) => ({ file: `${kShared}/synthetic/${row.file}`,
      options: { speed: row.speed_m_per_s, ...(row.force_view && { "force-view": row.force_view }) } }));
}

/** { file, options }; those of ../shared only where it is there. */
export function recordings() {
  const own = [{ file: "testdata/demo.csv", options: { speed: "10 mm/s" } }];
  if (!fs.existsSync(kShared)) return own;
  const real = filesBelow(`${kShared}/real`).filter((file) => /\.(csv|tsv|txt)$/.test(file));
  return [...own, ...synthetic(), ...real.map((file) => ({ file, options: realOptions(file) }))];
}
/** Damaged and odd files, one a line of the fuzz targets' seeds. */
export const hostileFiles = () => filesBelow("testdata/fuzz_corpus").filter((file) => fs.statSync(file).size < 1_000_000);

export const words = (options) => Object.entries(options).flatMap(([key, value]) =>
  [value].flat().map((one) => (one === true ? `--${key}` : `--${key}=${one}`)));

/** What the program says: { document } or { message, exit_code }. */
export async function native(command, file, options) {
  try {
    const done = await promisify(execFile)(path.resolve(process.env.SLIPFIT), [command, path.basename(file), "--json", "--quiet", ...words(options)],
      { cwd: path.dirname(file), maxBuffer: 1 << 30 });
    return { document: JSON.parse(done.stdout) };
  } catch (error) {
    return { message: error.stderr.trim().replace(/^slipfit: /, ""), exit_code: error.code };
  }
}

/** Probabilities this small are nothing in other words; the far tails amplify every rounding. */
const kNothing = 1e-6;
const relative = (a, b) => Math.abs(a - b) / Math.max(Math.abs(a), Math.abs(b), Number.MIN_VALUE);
const isTail = (place, a, b) => /(_p|probability|p_value)$/.test(place) && Math.abs(a) < kNothing && Math.abs(b) < kNothing;

/** The worst relative difference of two numbers, and where; anything else that differs is a fault. */
export function difference(a, b, place = "") {
  if (typeof a === "number" && typeof b === "number") {
    return { worst: a === b || isTail(place, a, b) ? 0 : relative(a, b), place, faults: [] };
  }
  if (a === null || b === null || typeof a !== "object" || typeof b !== "object") {
    return { worst: 0, place, faults: verdict(a, place) === verdict(b, place) ? [] : [`${place}: ${JSON.stringify(a)} and ${JSON.stringify(b)}`] };
  }
  return worstOf(Object.keys({ ...a, ...b }).map((key) => difference(a[key] ?? null, b[key] ?? null, place ? `${place}.${key}` : key)));
}
const worstOf = (parts) => parts.reduce((found, part) =>
  ({ ...(part.worst > found.worst ? part : found), faults: [...found.faults, ...part.faults] }), { worst: 0, place: "", faults: [] });

/** A sentence without its numbers, which are rounded, and stand in the document beside it where they matter; else what it is. */
function verdict(value, place) {
  const is_sentence = typeof value === "string" && /(message|reason|finding|note|assumed|conditional_on)(\.\d+)?$/.test(place);
  return is_sentence ? value.replace(/[-+]?\d[\d.e+-]*/g, "#") : value;
}

/** The worst difference of an estimate, in standard errors, and of the standard errors. */
export function differenceInErrors(a, b, place = "") {
  if (a === null || b === null || typeof a !== "object" || typeof b !== "object") return { worst: 0, place, faults: [] };
  if (typeof a.value === "number" && typeof b.value === "number" && a.se > 0 && b.se > 0) {
    return { worst: Math.max(Math.abs(a.value - b.value) / Math.max(a.se, b.se), relative(a.se, b.se)), place, faults: [] };
  }
  return worstOf(Object.keys(a).map((key) => differenceInErrors(a[key], b[key] ?? null, `${place}.${key}`)));
}

const kExact = 1e-8; // the math libraries round otherwise in the last digit
const kBuilds = 0.05; // of a standard error: scripts/compare_builds.py, between any two builds
const kNudge = 1e-13;

/** Whether the program's own numbers move by more than kExact where the speed is nudged: a fit that a rounding sends elsewhere. */
async function isTouchy(command, file, options, expected) {
  for (const nudge of [1 + kNudge, 1 - kNudge, 1 + 3 * kNudge, 1 - 3 * kNudge]) {
    const speed = String(options.speed ?? "1").replace(/^[\d.e-]+/, (number) => String(Number(number) * nudge));
    const other = await native(command, file, { ...options, speed });
    if (!other.document || difference(other.document, expected).worst > kExact) return true;
  }
  return false;
}

/** got: a document or { error }. Returns { faults, worst, place, touchy } against the program. */
export async function against(got, command, file, options) {
  const expected = await native(command, file, options);
  if (!expected.document) {
    const is_same = got.error?.message === expected.message && got.error?.exit_code === expected.exit_code;
    return { faults: is_same ? [] : [`${got.error?.message} and ${expected.message}`], worst: 0, refused: true };
  }
  const exact = difference(got, expected.document);
  if (exact.faults.length === 0 && exact.worst <= kExact) return exact;
  const faults = [...exact.faults];
  const errors = differenceInErrors(got, expected.document);
  if (errors.worst > kBuilds) faults.push(`${errors.place} differs by ${errors.worst} standard errors`);
  if (!(await isTouchy(command, file, options, expected.document))) faults.push(`${exact.place} differs by ${exact.worst}`);
  return { ...errors, faults, touchy: true };
}

/** Counts what `against` found, for a line of the test's report. */
export function tally() {
  const sum = { compared: 0, refused: 0, touchy: 0, worst: 0, worst_in_errors: 0 };
  return {
    sum,
    add(found) {
      if (found.refused) ++sum.refused;
      else ++sum.compared;
      if (found.touchy) ++sum.touchy, sum.worst_in_errors = Math.max(sum.worst_in_errors, found.worst);
      else sum.worst = Math.max(sum.worst, found.worst);
    },
    text: () => `${sum.compared} recordings compared, ${sum.compared - sum.touchy} agree to ${sum.worst.toExponential(1)}; ${sum.touchy} whose numbers move ` +
      `when their speed is nudged by 1e-13 agree to ${sum.worst_in_errors.toFixed(4)} standard errors; ${sum.refused} refused with the same words; statuses changed: 0`,
  };
}
