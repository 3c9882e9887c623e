// Copyright 2026 het_ros maintainers
// SPDX-License-Identifier: Apache-2.0
// Score and state over the last minute, with the value under the mouse.

import { COLOURS } from "./view.js";

const SPAN = 60; // s

export class Strip {
  #canvas;
  #output;
  #points = [];
  #mouse = null;

  constructor(canvas, output) {
    this.#canvas = canvas;
    this.#output = output;
    canvas.addEventListener("pointermove", (event) => this.#point(event.offsetX));
    canvas.addEventListener("pointerleave", () => this.#point(null));
    setInterval(() => this.#draw(), 200);
  }

  clear() {
    this.#points = [];
  }

  add({ state, score }) {
    const at = performance.now() / 1000;
    this.#points.push({ at, state, score });
    while (this.#points[0].at < at - SPAN) this.#points.shift();
  }

  #point(x) {
    this.#mouse = x;
    this.#draw();
  }

  #draw() {
    const canvas = this.#canvas;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = width * devicePixelRatio;
    canvas.height = height * devicePixelRatio;
    const pen = canvas.getContext("2d");
    pen.scale(devicePixelRatio, devicePixelRatio);
    const now = performance.now() / 1000;
    const x = (at) => width * (1 - (now - at) / SPAN);
    const band = 10;
    const y = (score) => 4 + (height - band - 8) * (1 - score);
    this.#points.forEach(({ at, state }, i) => {
      pen.fillStyle = COLOURS[state] ?? COLOURS.IDLE;
      const end = this.#points[i + 1]?.at ?? now;
      pen.fillRect(x(at), height - band, x(end) - x(at) + 0.5, band);
    });
    pen.strokeStyle = pen.fillStyle = getComputedStyle(canvas).color;
    pen.lineWidth = 1.5;
    pen.beginPath();
    for (const { at, score } of this.#points) pen.lineTo(x(at), y(score));
    pen.stroke();
    this.#drawMouse(pen, now, width, height, y);
  }

  #drawMouse(pen, now, width, height, y) {
    if (this.#mouse === null || !this.#points.length) {
      this.#output.textContent = "";
      return;
    }
    const at = now - SPAN * (1 - this.#mouse / width);
    const distance = (point) => Math.abs(point.at - at);
    const near = this.#points.reduce((a, b) => (distance(b) < distance(a) ? b : a));
    pen.fillRect(this.#mouse, 0, 1, height);
    pen.fillRect(this.#mouse - 3, y(near.score) - 3, 7, 7);
    const ago = (now - near.at).toFixed(1);
    this.#output.textContent = `${near.state}, score ${near.score.toFixed(2)}, ${ago} s ago`;
  }
}
