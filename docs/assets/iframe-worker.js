/* Pages that are opened as files may not start workers. There, a worker's script runs in a hidden frame instead,
   so that the site can be searched without a server. */
if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      this._frame = document.createElement("iframe");
      this._frame.hidden = true;
      this._loaded = new Promise((loaded) => this._frame.addEventListener("load", loaded, { once: true }));
      document.body.append(this._frame);
      const page = this._frame.contentDocument;
      const inside = this._frame.contentWindow;
      inside.postMessage = (data) => this._tell(data);
      inside.importScripts = (...urls) =>
        urls.reduce(
          (before, each) =>
            before.then(
              () =>
                new Promise((done, failed) => {
                  const script = page.createElement("script");
                  script.src = each;
                  script.onload = done;
                  script.onerror = failed;
                  page.body.append(script);
                })
            ),
          Promise.resolve()
        );
      this._started = inside.importScripts(url);
    }

    postMessage(data) {
      this._started.then(() => this._frame.contentWindow.dispatchEvent(new MessageEvent("message", { data })));
    }

    terminate() {
      this._frame.remove();
    }

    _tell(data) {
      const event = new MessageEvent("message", { data });
      this.dispatchEvent(event);
      if (typeof this.onmessage === "function") this.onmessage(event);
    }
  };
}
