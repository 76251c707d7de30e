// Computes beside the page, so that the page never waits: one request after another; to stop it the page ends the worker.
let slipfit = null;

/** packed: the program as the page holds it, gzip in base64; the page gets it compiled, for workers after this one. */
async function load({ packed, wasm }) {
  if (wasm) return makeSlipfit(wasm);
  try {
    const stream = new Blob([bytesOfBase64(packed)]).stream().pipeThrough(new DecompressionStream("gzip"));
    const compiled = await WebAssembly.compile(await new Response(stream).arrayBuffer());
    postMessage({ wasm: compiled });
    return makeSlipfit(compiled);
  } catch (error) {
    postMessage({ broken: error.message });
    throw error;
  }
}

onmessage = async ({ data }) => {
  if (!data.request) {
    slipfit = load(data);
    return;
  }
  const withBytes = async (file) => ({ name: file.name, bytes: new Uint8Array(await file.blob.arrayBuffer()) });
  try {
    const { files = [], surface, ...request } = data.request;
    const read = await Promise.all(files.map(withBytes));
    const result = (await slipfit).run({ ...request, files: read, surface: surface && (await withBytes(surface)) });
    postMessage({ id: data.id, result });
  } catch (error) {
    const message = `the file cannot be read (${error.message}); choose it again`;
    postMessage({ id: data.id, result: { exit_code: 3, notices: [], outputs: {}, error: { code: "not_readable", message, remedy: "choose it again", exit_code: 3 } } });
  }
};
