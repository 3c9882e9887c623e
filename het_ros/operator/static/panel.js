// Copyright 2026 het_ros maintainers
// SPDX-License-Identifier: Apache-2.0
// Buttons, parameters, figures and messages beside the picture.

export const $ = (id) => document.getElementById(id);
const MOST_LINES = 50;

/** Write a line into the log, newest first. */
export function say(text, bad = false) {
  const line = document.createElement("li");
  line.textContent = text;
  line.className = bad ? "bad" : "";
  $("log").prepend(line);
  while ($("log").children.length > MOST_LINES) $("log").lastChild.remove();
}

/** Show the names of the trackers; returns the one that is chosen. */
export function showTrackers(names, chosen) {
  const list = $("trackers");
  const wanted = names.includes(chosen) || !names.length ? chosen : names[0];
  const all = !wanted || names.includes(wanted) ? names : [...names, wanted];
  if ([...list.options].map((o) => o.value).join() !== all.join())
    list.replaceChildren(...all.map((name) => new Option(name, name)));
  list.value = wanted;
  return wanted;
}

/** The form of the parameters; change(name, value) is called when one is set. */
export function showParameters(parameters, change) {
  if ($("parameters").contains(document.activeElement)) return;
  $("parameters").replaceChildren(...parameters.map((p) => field(p, change)));
}

function field({ name, value, help, low, high, whole }, change) {
  const label = document.createElement("label");
  const input = document.createElement("input");
  const text = document.createElement("small");
  const flag = typeof value === "boolean";
  input.type = flag ? "checkbox" : "number";
  input.name = name;
  if (flag) input.checked = value;
  else {
    input.value = value;
    if (low !== null) [input.min, input.max] = [low, high];
    input.step = whole ? 1 : "any";
  }
  input.addEventListener("change", () => {
    if (input.reportValidity()) change(name, flag ? input.checked : input.valueAsNumber);
    input.blur();
  });
  const range = low === null || flag ? "" : ` ${low} to ${high}.`;
  text.textContent = `${help}.${range}`;
  label.append(input, ` ${name}`, text);
  return label;
}

export function showRecording({ on, path, bytes }) {
  $("record").textContent = on ? "Stop recording" : "Record";
  $("record").setAttribute("aria-pressed", on);
  $("recording").textContent = on ? `${path}, ${(bytes / 1e6).toFixed(1)} MB` : "";
}

/** Frame rate, latency and drops of the last seconds. */
export class Figures {
  #shown = [];
  #number = null;
  dropped = 0;

  constructor() {
    setInterval(() => this.#show(), 500);
  }

  clear() {
    this.#shown = [];
    this.#number = null;
    this.dropped = 0;
  }

  /** A picture came (not all are drawn): count those before it that did not. */
  came(number) {
    if (this.#number !== null && number > this.#number) this.dropped += number - this.#number - 1;
    this.#number = number;
  }

  drawn(latency) {
    this.#shown.push({ at: performance.now(), latency });
    if (this.#shown.length > 300) this.#shown.shift();
  }

  /** Pictures a second over the last 5 s, median and 95th percentile of their latency in ms. */
  get all() {
    const now = performance.now();
    const recent = this.#shown.filter(({ at }) => at > now - 5000);
    const sorted = recent.map(({ latency }) => latency).sort((a, b) => a - b);
    const part = (share) => sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)];
    const span = recent.length > 1 ? (recent.at(-1).at - recent[0].at) / 1000 : Infinity;
    const rate = (recent.length - 1) / span;
    return { rate: Math.max(rate, 0), median: part(0.5), p95: part(0.95), dropped: this.dropped };
  }

  #show() {
    const { rate, median, p95, dropped } = this.all;
    const some = median !== undefined;
    $("rate").textContent = some ? `${rate.toFixed(1)} /s` : "none";
    $("latency").textContent = some ? `${median.toFixed(0)} ms (p95 ${p95.toFixed(0)})` : "-";
    $("dropped").textContent = dropped;
  }
}
