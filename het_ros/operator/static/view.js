// Copyright 2026 het_ros maintainers
// SPDX-License-Identifier: Apache-2.0
// The camera's picture with what the tracker says of it, drawn here so that it costs it nothing.

export const COLOURS = {
  TRACKING: "#2ee66b",
  COASTING: "#ffb020",
  LOST: "#ff4d5e",
  IDLE: "#b8b8b8",
};
const PATH = 10; // s of the path that are drawn
const AHEAD = 0.5; // s to where the target is predicted

const seconds = (stamp) => Number(BigInt(stamp) / 1000n) / 1e6;

export class View {
  #canvas;
  #pen;
  #queued = false;
  #path = [];
  #pending = null;

  /** onDrawn is called with each picture when it is on the canvas for the first time. */
  constructor(canvas, onDrawn) {
    this.#canvas = canvas;
    this.#pen = canvas.getContext("2d", { alpha: false });
    this.onDrawn = onDrawn;
    this.image = null; // the newest
    this.frozen = null; // the one that a box is drawn on
    this.track = null;
    this.box = null; // the operator's, px of the image
    new ResizeObserver(() => this.redraw()).observe(canvas);
  }

  get shown() {
    return this.frozen ?? this.image;
  }

  /** Canvas px in one px of the image. */
  get scale() {
    return this.shown ? this.#canvas.width / this.shown.size[0] : 1;
  }

  clear() {
    this.image = this.frozen = this.track = null;
    this.#path = [];
    this.redraw();
  }

  addImage(image) {
    if (this.image && this.image !== this.frozen) this.image.bitmap.close();
    this.image = this.#pending = image;
    this.redraw();
  }

  addTrack(track) {
    this.track = track;
    if (track.box) {
      const [x, y, w, h] = track.box;
      this.#path.push({ at: seconds(track.stamp), x: x + w / 2, y: y + h / 2 });
    }
    if (!track.box && track.state !== "LOST") this.#path = [];
    const oldest = seconds(track.stamp) - PATH;
    while (this.#path.length && !(this.#path[0].at >= oldest)) this.#path.shift();
    this.redraw();
  }

  freeze() {
    this.frozen = this.image;
    return this.frozen !== null;
  }

  thaw() {
    if (this.frozen && this.frozen !== this.image) this.frozen.bitmap.close();
    this.frozen = this.box = null;
    this.redraw();
  }

  /** Where a pointer's event is, px of the image. */
  place(event) {
    const area = this.#canvas.getBoundingClientRect();
    const [width, height] = this.shown.size;
    const shrink = Math.min(area.width / width, area.height / height);
    const left = area.left + (area.width - width * shrink) / 2;
    return [(event.clientX - left) / shrink, (event.clientY - area.top) / shrink];
  }

  redraw() {
    if (this.#queued) return;
    this.#queued = true;
    requestAnimationFrame(() => {
      this.#queued = false;
      this.#draw();
    });
  }

  #draw() {
    const shown = this.shown;
    const pen = this.#pen;
    if (!shown) {
      pen.clearRect(0, 0, this.#canvas.width, this.#canvas.height);
      return;
    }
    const width = Math.round(this.#canvas.clientWidth * devicePixelRatio) || shown.size[0];
    const height = Math.round((width * shown.size[1]) / shown.size[0]);
    if (this.#canvas.width !== width || this.#canvas.height !== height) {
      this.#canvas.width = width;
      this.#canvas.height = height;
    }
    pen.drawImage(shown.bitmap, 0, 0, width, height);
    pen.lineWidth = 2.5 * devicePixelRatio;
    if (this.frozen) this.#drawPick();
    else if (this.track) this.#drawTrack(shown);
    if (this.#pending) {
      if (!this.frozen) this.onDrawn(this.#pending);
      this.#pending = null;
    }
  }

  #drawTrack(shown) {
    const { box, velocity, state, score, stamp } = this.track;
    const colour = COLOURS[state] ?? COLOURS.IDLE;
    this.#drawPath(colour);
    if (!box) return;
    // The answer for the picture may still be on its way: go on from the last one until it is here.
    const late = Math.max(seconds(shown.stamp) - seconds(stamp), 0);
    const behind = late > AHEAD; // the tracker is catching up: its box is where the target was
    const [vx, vy] = velocity && !behind ? velocity : [0, 0];
    const [x, y, w, h] = box;
    const here = [x + vx * late, y + vy * late, w, h];
    this.#rectangle(here, colour, behind || state === "COASTING" ? [8, 6] : []);
    const [ax, ay] = [vx * AHEAD, vy * AHEAD];
    if (Math.hypot(ax, ay) > 0.15 * Math.sqrt(w * h)) {
      this.#rectangle([here[0] + ax, here[1] + ay, w, h], colour, [2, 6]);
      this.#arrow(here[0] + w / 2, here[1] + h / 2, ax, ay, colour);
    }
    const lag = behind ? `, ${late.toFixed(1)} s behind` : "";
    this.#word(`${state} ${score.toFixed(2)}${lag}`, here, colour);
  }

  #drawPath(colour) {
    const pen = this.#pen;
    pen.beginPath();
    for (const { x, y } of this.#path) pen.lineTo(x * this.scale, y * this.scale);
    pen.globalAlpha = 0.6;
    this.#stroke(colour);
    pen.globalAlpha = 1;
  }

  #drawPick() {
    const pen = this.#pen;
    const { width, height } = this.#canvas;
    pen.fillStyle = "rgb(0 0 0 / 45%)";
    if (!this.box) return;
    const [x, y, w, h] = this.box.map((part) => part * this.scale);
    pen.beginPath();
    pen.rect(0, 0, width, height);
    pen.rect(x, y, w, h);
    pen.fill("evenodd");
    this.#rectangle(this.box, "#fff", []);
    const side = 7 * devicePixelRatio;
    pen.fillStyle = "#fff";
    for (const fx of [0, 0.5, 1])
      for (const fy of [0, 0.5, 1])
        if (fx !== 0.5 || fy !== 0.5)
          pen.fillRect(x + fx * w - side / 2, y + fy * h - side / 2, side, side);
  }

  #rectangle(box, colour, dash) {
    const pen = this.#pen;
    pen.beginPath();
    pen.rect(...box.map((part) => part * this.scale));
    pen.setLineDash(dash.map((part) => part * devicePixelRatio));
    this.#stroke(colour);
    pen.setLineDash([]);
  }

  #arrow(x, y, dx, dy, colour) {
    const pen = this.#pen;
    const [tipX, tipY] = [(x + dx) * this.scale, (y + dy) * this.scale];
    const turn = Math.atan2(dy, dx);
    pen.beginPath();
    pen.moveTo(x * this.scale, y * this.scale);
    pen.lineTo(tipX, tipY);
    for (const side of [-1, 1]) {
      const angle = turn + Math.PI + side * 0.5;
      const length = 10 * devicePixelRatio;
      pen.moveTo(tipX, tipY);
      pen.lineTo(tipX + length * Math.cos(angle), tipY + length * Math.sin(angle));
    }
    this.#stroke(colour);
  }

  /** A coloured line with a dark rim, which is seen on any ground. */
  #stroke(colour) {
    const pen = this.#pen;
    const thick = pen.lineWidth;
    pen.lineWidth = 2 * thick;
    pen.strokeStyle = "rgb(0 0 0 / 55%)";
    pen.stroke();
    pen.lineWidth = thick;
    pen.strokeStyle = colour;
    pen.stroke();
  }

  #word(text, [x, y, , h], colour) {
    const pen = this.#pen;
    const size = 14 * devicePixelRatio;
    pen.font = `600 ${size}px system-ui, sans-serif`;
    const width = pen.measureText(text).width + size;
    const left = Math.min(Math.max(x * this.scale, 0), this.#canvas.width - width);
    const above = y * this.scale - 1.6 * size;
    const top = above >= 0 ? above : Math.min((y + h) * this.scale, this.#canvas.height - 1.5 * size);
    pen.fillStyle = "rgb(0 0 0 / 75%)";
    pen.fillRect(left, top, width, 1.5 * size);
    pen.fillStyle = colour;
    pen.fillText(text, left + size / 2, top + 1.1 * size);
  }
}
