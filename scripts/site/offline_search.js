// Search on pages that are opened from a disk, where browsers allow neither requests nor workers: the index comes as a script
// (scripts/docs.sh writes it), and the theme's worker runs in a hidden frame.
if (location.protocol === "file:") {
  const index = document.createElement("script");
  index.src = document.currentScript.dataset.index;
  window.__search = { index: new Promise((done) => { index.onload = () => done(window.searchIndex); }) };
  document.head.append(index);

  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      const frame = document.createElement("iframe");
      frame.hidden = true;
      document.body.append(frame);
      this.inner = frame.contentWindow;
      this.inner.postMessage = (data) => this.dispatchEvent(new MessageEvent("message", { data }));
      const script = this.inner.document.createElement("script");
      script.src = new URL(url, location.href).href;
      this.ready = new Promise((done) => { script.onload = done; });
      this.inner.document.body.append(script);
    }

    postMessage(data) {
      this.ready.then(() => this.inner.dispatchEvent(new MessageEvent("message", { data })));
    }
  };
}
