// Computes beside the page, so that the page never waits: one request after another; to stop it the page ends the worker.
let slipfit = null;
onmessage = async ({ data }) => {
  if (data.wasm) {
    slipfit = makeSlipfit(data.wasm);
    return;
  }
  const withBytes = async (file) => ({ name: file.name, bytes: new Uint8Array(await file.blob.arrayBuffer()) });
  try {
    const { files = [], surface, ...request } = data.request;
    const read = await Promise.all(files.map(withBytes));
    const result = slipfit.run({ ...request, files: read, surface: surface && (await withBytes(surface)) });
    postMessage({ id: data.id, result });
  } catch (error) {
    const message = `the file cannot be read (${error.message}); choose it again`;
    postMessage({ id: data.id, result: { exit_code: 3, notices: [], outputs: {}, error: { code: "not_readable", message, remedy: "choose it again", exit_code: 3 } } });
  }
};
