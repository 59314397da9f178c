// SPDX-License-Identifier: Apache-2.0
import { readFrame } from "./frames.js";

const PROTOCOL = "rds.view.v1";
const AGAIN_MS = 1000;

/// The WebSocket to rds-viewer; connects again until it is there. Calls listener(kind, content), with kind "connected" and true or false, too.
/// Opens before the page has a listener, so that the map is under way while the page's other files are: what comes until then waits.
class Connection {
  constructor() {
    this.waiting = [];
    this.wantsPicture = false;
    this.open();
  }

  listen(listener) {
    this.listener = listener;
    for (const told of this.waiting.splice(0)) listener(...told);
  }

  tell(kind, content) {
    if (this.listener) this.listener(kind, content);
    else this.waiting.push([kind, content]);
  }

  open() {
    const url = new URL("socket", location.href);
    url.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    url.hash = "";
    url.search = "";
    const token = new URLSearchParams(location.search).get("token");
    if (token) url.search = `?token=${encodeURIComponent(token)}`;
    this.socket = new WebSocket(url, PROTOCOL);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.tell("connected", true);
      this.say({ picture: this.wantsPicture });
    };
    this.socket.onmessage = ({ data }) => {
      const frame = data instanceof ArrayBuffer ? readFrame(data) : null;
      if (frame) this.tell(...frame);
    };
    this.socket.onclose = () => {
      this.tell("connected", false);
      setTimeout(() => this.open(), AGAIN_MS);
    };
  }

  say(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  wantPicture(wanted) {
    this.wantsPicture = wanted;
    this.say({ picture: wanted });
  }
}

export const connection = new Connection();
