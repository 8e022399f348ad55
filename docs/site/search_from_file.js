// Lets the search work in pages that are opened from a disk. Browsers give such pages neither a worker nor the index by a
// request. So the index comes as a script (kadans_search_index), and what is written for a worker runs in a hidden frame.
"use strict";
if (location.protocol === "file:") {
  window.__search = { index: Promise.resolve(kadans_search_index) };
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      const frame = document.createElement("iframe");
      frame.hidden = true;
      document.body.appendChild(frame);
      this.window = frame.contentWindow;
      this.loaded = new Promise((resolve) => {
        this.window.kadans_loaded = resolve;
      });
      this.window.kadans_answer = (data) => this.dispatchEvent(new MessageEvent("message", { data }));
      const page = this.window.document;
      const after = (code) => {
        const script = page.createElement("script");
        script.textContent = code;
        page.body.appendChild(script);
      };
      after("var postMessage = kadans_answer; var importScripts = () => {};");
      const worker = page.createElement("script");
      worker.src = url;
      worker.onload = () => this.window.kadans_loaded();
      page.body.appendChild(worker);
    }
    postMessage(data) {
      this.loaded.then(() => this.window.dispatchEvent(new MessageEvent("message", { data })));
    }
    terminate() {}
  };
}
