// SPDX-License-Identifier: Apache-2.0
const MOST_REPLIES = 8;

/// Pause, reset and save; what the services answer.
export class Commands {
  constructor(section, say) {
    this.section = section;
    this.replies = section.querySelector("#replies");
    this.pause = section.querySelector("#pause");
    this.paused = false;
    this.pause.onclick = () => say({ command: this.paused ? "resume" : "pause" });
    section.querySelector("#reset").onclick = () => {
      if (confirm("Forget the map and begin anew?")) say({ command: "reset" });
    };
    section.querySelector("#save-form").onsubmit = (event) => {
      event.preventDefault();
      say({ command: "save", argument: section.querySelector("#save-name").value });
    };
  }

  allow(allowed) {
    this.section.hidden = !allowed;
  }

  reply({ verb, service, success, message }) {
    if (success && (verb === "pause" || verb === "resume")) {
      this.paused = verb === "pause";
      this.pause.textContent = this.paused ? "Resume" : "Pause";
    }
    const line = document.createElement("li");
    line.textContent = `${service.replace("rds-", "")}: ${success ? `${verb} done` : message}`;
    line.classList.toggle("bad", !success);
    this.replies.prepend(line);
    while (this.replies.children.length > MOST_REPLIES) this.replies.lastChild.remove();
  }
}
