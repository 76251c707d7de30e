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

const relative = (a, b) => Math.abs(a - b) / Math.max(Math.abs(a), Math.abs(b), Number.MIN_VALUE);
/** Correlations near 0 are differences of numbers of size 1: compared as such. */
const isCorrelation = (place) => /^correlation\./.test(place);
/** A tail exp(-x) changes by x times what x does; x is 700 at most: compared by x, its logarithm. */
const kTail = 1e-6;
const isTail = (place, a, b) => /(_p|probability|p_value)$/.test(place) && a > 0 && b > 0 && a < kTail && b < kTail;
function distance(a, b, place) {
  if (a === b) return 0;
  if (isCorrelation(place)) return Math.abs(a - b);
  return isTail(place, a, b) ? relative(Math.log(a), Math.log(b)) : relative(a, b);
}

/**
 * The worst relative difference of two numbers, and where; sentences with other numbers (misquoted); anything else that
 * differs is a fault.
 */
export function difference(a, b, place = "") {
  if (typeof a === "number" && typeof b === "number") return { worst: distance(a, b, place), place, faults: [], misquoted: [] };
  if (a === null || b === null || typeof a !== "object" || typeof b !== "object") {
    return { worst: 0, place, faults: [], misquoted: [], ...faultOf(a, b, place) };
  }
  return worstOf(Object.keys({ ...a, ...b }).map((key) => difference(a[key] ?? null, b[key] ?? null, place ? `${place}.${key}` : key)));
}
const worstOf = (parts) => parts.reduce((found, part) =>
  ({ ...(part.worst > found.worst ? part : found), faults: [...found.faults, ...part.faults],
    misquoted: [...found.misquoted, ...part.misquoted] }), { worst: 0, place: "", faults: [], misquoted: [] });

const isSentence = (value, place) => typeof value === "string" && /(message|reason|finding|note|assumed|conditional_on)(\.\d+)?$/.test(place);
const kNumber = /[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?/g;
/** By how many units of its last digit a number in a sentence may differ: what is rounded may fall to either side. */
function inUnitsOfLastDigit(a, b) {
  const unit = (text) => 10 ** (Number(/e([-+]?\d+)/.exec(text)?.[1] ?? 0) - (/\.(\d+)/.exec(text)?.[1].length ?? 0));
  return Math.abs(Number(a) - Number(b)) / Math.max(unit(a), unit(b));
}
/** Where two values that are no numbers say different things: sentences with the same words may differ in a last digit. */
function faultOf(a, b, place) {
  if (a === b) return {};
  const told = [`${place}: ${JSON.stringify(a)} and ${JSON.stringify(b)}`];
  if (!isSentence(a, place) || !isSentence(b, place) || a.replace(kNumber, "#") !== b.replace(kNumber, "#")) return { faults: told };
  const others = b.match(kNumber);
  return a.match(kNumber).every((number, i) => inUnitsOfLastDigit(number, others[i]) < 1.5) ? {} : { misquoted: told };
}

/** The worst difference of an estimate, in standard errors, and of the standard errors. */
export function differenceInErrors(a, b, place = "") {
  if (a === null || b === null || typeof a !== "object" || typeof b !== "object") return { worst: 0, place, faults: [], misquoted: [] };
  if (typeof a.value === "number" && typeof b.value === "number" && a.se > 0 && b.se > 0) {
    return { worst: Math.max(Math.abs(a.value - b.value) / Math.max(a.se, b.se), relative(a.se, b.se)), place, faults: [], misquoted: [] };
  }
  return worstOf(Object.keys(a).map((key) => differenceInErrors(a[key], b[key] ?? null, `${place}.${key}`)));
}

const kExact = 1e-8; // the math libraries round otherwise in the last digit
const kBuilds = 0.05; // of a standard error: scripts/compare_builds.py, between any two builds
const kNudge = 1e-13;

/**
 * How far the program's own numbers move where the speed is nudged: whether by more than kExact (a fit that a rounding sends elsewhere),
 * and by how many standard errors at most. No other math library can be asked to agree better than that.
 */
async function ownMovement(command, file, options, expected) {
  const movement = { isTouchy: false, errors: 0 };
  for (const nudge of [1 + kNudge, 1 - kNudge, 1 + 3 * kNudge, 1 - 3 * kNudge]) {
    const speed = String(options.speed ?? "1").replace(/^[\d.e-]+/, (number) => String(Number(number) * nudge));
    const other = await native(command, file, { ...options, speed });
    if (!other.document) return { isTouchy: true, errors: Infinity };
    const [theirs, moved] = [withoutRefusedTrial(expected), withoutRefusedTrial(other.document)];
    const exact = difference(moved, theirs);
    movement.isTouchy ||= exact.worst > kExact || exact.misquoted.length > 0;
    movement.errors = Math.max(movement.errors, differenceInErrors(moved, theirs).worst);
  }
  return movement;
}

/** Without the numbers of a refused trial of slip weakening: where it explains nothing its search ends anywhere, or nowhere. */
function withoutRefusedTrial(document) {
  const candidates = document.model?.candidates;
  if (!candidates) return document;
  const kept = candidates.map((one) => (one.tier === "weakening" && !one.chosen ? { tier: one.tier, chosen: false } : one));
  return { ...document, model: { ...document.model, candidates: kept } };
}

/** got: a document or { error }. Returns { faults, worst, place, touchy } against the program. */
export async function against(got, command, file, options) {
  const expected = await native(command, file, options);
  if (!expected.document) {
    const is_same = got.error?.message === expected.message && got.error?.exit_code === expected.exit_code;
    return { faults: is_same ? [] : [`${got.error?.message} and ${expected.message}`], worst: 0, refused: true };
  }
  const [ours, theirs] = [withoutRefusedTrial(got), withoutRefusedTrial(expected.document)];
  const exact = difference(ours, theirs);
  if (exact.faults.length === 0 && exact.misquoted.length === 0 && exact.worst <= kExact) return exact;
  const faults = [...exact.faults];
  const errors = differenceInErrors(ours, theirs);
  const own = await ownMovement(command, file, options, expected.document);
  if (errors.worst > Math.max(kBuilds, own.errors)) faults.push(`${errors.place} differs by ${errors.worst} standard errors`);
  if (!own.isTouchy) faults.push(`${exact.place} differs by ${exact.worst}`, ...exact.misquoted);
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
