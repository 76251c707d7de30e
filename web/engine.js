// The program in a worker: one request at a time; stopping ends the worker and begins another.
const engine = (() => {
  "use strict";
  const text = document.getElementById("engine-text").textContent;
  let compiled = null;
  let worker = null;
  let waiting = null;
  let next = 0;
  let queue = Promise.resolve();

  async function compile() {
    const packed = bytesOfBase64(document.getElementById("engine-wasm").textContent);
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return WebAssembly.compile(await new Response(stream).arrayBuffer());
  }
  async function begin() {
    compiled ??= compile();
    const wasm = await compiled;
    const address = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
    worker = new Worker(address);
    worker.onmessage = ({ data }) => waiting?.id === data.id && waiting.done(data.result);
    worker.onerror = (event) => waiting?.fail(new Error(event.message));
    worker.postMessage({ wasm });
  }
  async function ask(request) {
    if (!worker) await begin();
    return new Promise((done, fail) => {
      waiting = { id: ++next, done, fail };
      worker.postMessage({ id: next, request });
    });
  }
  return {
    /** Resolves to what run() of api.js returns; rejects with "stopped". */
    call(request) {
      const answer = queue.then(() => ask(request));
      queue = answer.catch(() => {});
      return answer;
    },
    stop() {
      worker?.terminate();
      worker = null;
      waiting?.fail(new Error("stopped"));
    },
    ready: () => (compiled ??= compile()),
  };
})();
