// SPDX-License-Identifier: Apache-2.0
import { readFrame } from "./frames.js";

const PROTOCOL = "rds.view.v1";
const AGAIN_MS = 1000;

/// The WebSocket to rds-viewer; connects again until it is there. Calls listener[kind](content), and listener.connected(true or false).
export class Connection {
  constructor(listener) {
    this.listener = listener;
    this.wantsPicture = false;
    this.open();
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
      this.listener.connected(true);
      this.say({ picture: this.wantsPicture });
    };
    this.socket.onmessage = ({ data }) => {
      const frame = data instanceof ArrayBuffer ? readFrame(data) : null;
      if (frame) this.listener[frame[0]]?.(frame[1]);
    };
    this.socket.onclose = () => {
      this.listener.connected(false);
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
