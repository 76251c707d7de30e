// The program in a worker: one request at a time; stopping ends the worker and begins another.
const engine = (() => {
  "use strict";
  const textOf = (id) => document.getElementById(id).textContent;
  let wasm = null; // compiled by the first worker, for those after it
  let worker = null;
  let waiting = null;
  let next = 0;
  let queue = Promise.resolve();
  let told = {};
  const ready = new Promise((done, fail) => { told = { done, fail }; });

  function begin() {
    const address = URL.createObjectURL(new Blob([textOf("engine-text")], { type: "text/javascript" }));
    worker = new Worker(address);
    worker.onmessage = ({ data }) => {
      if (data.wasm) {
        wasm = data.wasm;
        told.done();
      } else if (data.broken) {
        told.fail(new Error(data.broken));
      } else if (waiting?.id === data.id) {
        waiting.done(data.result);
      }
    };
    worker.onerror = (event) => waiting?.fail(new Error(event.message));
    worker.postMessage(wasm ? { wasm } : { packed: textOf("engine-wasm") });
  }
  function ask(request) {
    if (!worker) begin();
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
    /** Rejects where this browser cannot run the program. */
    ready() {
      if (!worker) begin();
      return ready;
    },
  };
})();
