// SPDX-License-Identifier: Apache-2.0
const GONE_S = 5; // five reports are missing
const SHORTEST_S = 0.7; // reports come once a second

/// A row for each service that was heard: health, processor, memory, its slowest stage, messages lost.
export class Services {
  constructor(table) {
    this.body = table.tBodies[0];
    this.before = new Map(); // processor time, by name
  }

  show(services) {
    const now = performance.now() / 1000;
    this.body.replaceChildren(...Object.entries(services).flatMap(([name, s]) => this.rows(name, s, now)));
  }

  /// Between two reports; a service that began anew has none yet.
  cpu(name, cpu_s, at) {
    const before = this.before.get(name);
    if (before && at - before.at < SHORTEST_S) return before.share;
    const share = before && cpu_s >= before.cpu_s ? (100 * (cpu_s - before.cpu_s)) / (at - before.at) : null;
    this.before.set(name, { cpu_s, at, share });
    return share;
  }

  rows(name, s, now) {
    const gone = s.heard_s_ago > GONE_S;
    const level = gone ? 3 : s.level;
    const share = this.cpu(name, s.cpu_s, now - s.heard_s_ago);
    const slowest = Math.max(0, ...Object.values(s.latencies_ms).map(([, p99]) => p99));
    const row = document.createElement("tr");
    row.innerHTML = `<td><i class="health" data-level="${level}"></i></td><td></td><td></td><td></td><td></td>`;
    const said = ["well", "warns", "error", "gone"][level];
    row.cells[0].append(name.replace("rds-", ""), Object.assign(document.createElement("span"), { className: "hidden", textContent: `, ${said}` }));
    [gone || share === null ? "–" : `${share.toFixed(0)} %`, s.rss_mb.toFixed(0), slowest ? slowest.toFixed(slowest < 10 ? 1 : 0) : "–", s.dropped + s.rejected].forEach((text, i) => (row.cells[i + 1].textContent = text));
    const message = gone ? `silent for ${s.heard_s_ago.toFixed(0)} s` : s.message;
    if (!message) return [row];
    const second = document.createElement("tr");
    second.innerHTML = "<td class=\"message\" colspan=\"5\"></td>";
    second.cells[0].textContent = message;
    return [row, second];
  }
}
