// The end of slipfit.mjs: loads slipfit.wasm, which stands beside it, in node and in browsers.
const address = new URL("slipfit.wasm", import.meta.url);
async function load() {
  if (address.protocol !== "file:") return WebAssembly.compile(await (await fetch(address)).arrayBuffer());
  const { readFile } = await import("node:fs/promises");
  return WebAssembly.compile(await readFile(address));
}
const slipfit = makeSlipfit(await load());
export const { run, fit, analyze, info, surface, report, cycles, curve, predict, sweep, compare, memoryBytes } = slipfit;
/** For those who expect a function that loads: everything is loaded when the import is. */
export default Object.assign(async () => slipfit, slipfit);
