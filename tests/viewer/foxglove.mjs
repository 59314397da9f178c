// SPDX-License-Identifier: Apache-2.0
// foxglove.mjs URL PROTOCOL: a client of Foxglove's protocol, by its own library: subscribes to all channels, decodes what comes by their
// schemas, and prints at the end of standard input what each channel had: {topic: {messages, bytes, newest}}.
import { createHash } from "node:crypto";
import { createRequire } from "node:module";

const require = createRequire(import.meta.url); // these packages are CommonJS
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");
const WebSocket = require("ws");

const [url, protocol] = process.argv.slice(2);
const client = new FoxgloveClient({ ws: new WebSocket(url, [protocol]) });
const heard = {};
const subscriptions = new Map();
client.on("error", (error) => (heard.error = String(error)));
client.on("serverInfo", (info) => (heard.server = info));
client.on("advertise", (channels) => {
  for (const channel of channels) {
    const reader = new MessageReader(parse(channel.schema, { ros2: true }));
    heard[channel.topic] = { messages: 0, bytes: 0, encoding: channel.encoding, schemaEncoding: channel.schemaEncoding, schemaName: channel.schemaName, sha256: [] };
    subscriptions.set(client.subscribe(channel.id), { topic: channel.topic, reader });
  }
  console.log(JSON.stringify({ ready: true, channels: channels.length }));
});
const summary = (value) => JSON.parse(JSON.stringify(value, (_, v) => (typeof v === "bigint" ? Number(v) : ArrayBuffer.isView(v) ? { length: v.length } : Array.isArray(v) && v.length > 3 ? { length: v.length, first: v[0] } : v)));
client.on("message", ({ subscriptionId, data }) => {
  const { topic, reader } = subscriptions.get(subscriptionId);
  const of = heard[topic];
  ++of.messages;
  of.bytes += data.byteLength;
  of.sha256.push(createHash("sha256").update(data).digest("hex"));
  try {
    of.newest = summary(reader.readMessage(data));
  } catch (error) {
    of.error = String(error);
  }
});
process.stdin.on("end", () => {
  process.stdout.write(`${JSON.stringify(heard)}\n`, () => process.exit(0));
});
process.stdin.resume();
