// Copyright 2026 het_ros maintainers
// SPDX-License-Identifier: Apache-2.0
// A box on the frozen picture: drawn, moved by its edges and corners or by keys, sent or let go.

const SMALLEST = 4; // px of the image: less is a stray touch
const GRIP = { mouse: 10, pen: 14, touch: 24 }; // px of the screen
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Which edges of a box are within reach of a place; [0, 0] is its inside, null is outside. */
export function gripOf([x, y, w, h], [px, py], reach) {
  const near = (low, size, at) => {
    const inner = Math.min(reach, size / 3); // leaves an inside to small boxes
    if (at < low - reach || at > low + size + reach) return null;
    if (at < low + inner) return -1;
    return at > low + size - inner ? 1 : 0;
  };
  const [gx, gy] = [near(x, w, px), near(y, h, py)];
  return gx === null || gy === null ? null : [gx, gy];
}

/** A box of which the edges that are held, or the whole of it, are moved. */
export function moved([x, y, w, h], [gx, gy], dx, dy) {
  if (gx === 0 && gy === 0) return [x + dx, y + dy, w, h];
  const left = gx < 0 ? x + dx : x;
  const top = gy < 0 ? y + dy : y;
  return spanned(left, top, gx > 0 ? x + w + dx : x + w, gy > 0 ? y + h + dy : y + h);
}

function spanned(x0, y0, x1, y1) {
  return [Math.min(x0, x1), Math.min(y0, y1), Math.abs(x1 - x0), Math.abs(y1 - y0)];
}

export class Pick {
  #canvas;
  #view;
  #drag = null;
  sending = false;

  /** hooks: onFreeze(on), onChange(), isDirect(), send(box, stamp) -> whether it was accepted. */
  constructor(canvas, view, hooks) {
    this.#canvas = canvas;
    this.#view = view;
    this.hooks = hooks;
    canvas.addEventListener("pointerdown", (event) => this.#press(event));
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    canvas.addEventListener("pointerup", (event) => this.#release(event));
    canvas.addEventListener("pointercancel", () => this.letGo());
  }

  get active() {
    return this.#view.frozen !== null;
  }

  /** Freeze with a box in the middle, or where the target was: for keys, and to pick again. */
  begin() {
    if (!this.active && !this.#freeze()) return;
    const [width, height] = this.#view.frozen.size;
    const last = this.#view.track?.box;
    this.#view.box ??= last ?? [0.45 * width, 0.35 * height, 0.1 * width, 0.3 * height];
    this.#changed();
    this.#canvas.focus();
  }

  letGo() {
    this.#drag = null;
    if (!this.active) return;
    this.#view.thaw();
    this.hooks.onFreeze(false);
    this.hooks.onChange();
  }

  async send() {
    const { box, frozen } = this.#view;
    if (!box || this.sending || Math.min(box[2], box[3]) < 1) return;
    this.sending = true;
    try {
      if (await this.hooks.send(box, frozen.stamp)) this.letGo();
    } finally {
      this.sending = false;
    }
  }

  /** Whether the key was one of the box's. */
  key(event) {
    if (!this.active) return false;
    const step = event.shiftKey ? 10 : 1;
    if (event.key in ARROWS && this.#view.box) {
      const [dx, dy] = ARROWS[event.key];
      const grip = event.ctrlKey || event.altKey ? [Math.abs(dx), Math.abs(dy)] : [0, 0];
      this.#view.box = moved(this.#view.box, grip, dx * step, dy * step);
      this.#changed();
    } else if (event.key === "Enter") this.send();
    else if (event.key === "Escape") this.letGo();
    else return false;
    return true;
  }

  #freeze() {
    if (!this.#view.freeze()) return false;
    this.hooks.onFreeze(true);
    return true;
  }

  #changed() {
    this.#view.redraw();
    this.hooks.onChange();
  }

  #press(event) {
    if (!event.isPrimary || event.button !== 0 || this.sending) return;
    if (!this.active && !this.#freeze()) return;
    this.#canvas.setPointerCapture(event.pointerId);
    this.#canvas.focus();
    const at = this.#view.place(event);
    const box = this.#view.box;
    const perPixel = this.#view.frozen.size[0] / this.#canvas.clientWidth;
    const grip = box && gripOf(box, at, (GRIP[event.pointerType] ?? 10) * perPixel);
    this.#drag = { at, grip, box, pointer: event.pointerId };
    event.preventDefault();
  }

  #move(event) {
    if (this.#drag?.pointer !== event.pointerId) return;
    const { at, grip, box } = this.#drag;
    const [x, y] = this.#view.place(event);
    const [dx, dy] = [x - at[0], y - at[1]];
    if (grip) this.#view.box = moved(box, grip, dx, dy);
    else if (Math.min(Math.abs(dx), Math.abs(dy)) >= SMALLEST)
      this.#view.box = this.#inside(spanned(...at, x, y));
    this.#changed();
  }

  #release(event) {
    if (this.#drag?.pointer !== event.pointerId) return;
    this.#move(event);
    const drawn = this.#view.box !== this.#drag.box && !this.#drag.grip;
    this.#drag = null;
    if (!this.#view.box) this.letGo(); // a stray touch
    else if (drawn && event.pointerType === "mouse" && this.hooks.isDirect()) this.send();
  }

  #inside([x, y, w, h]) {
    const [width, height] = this.#view.frozen.size;
    const [left, top] = [Math.max(x, 0), Math.max(y, 0)];
    return [left, top, Math.min(x + w, width) - left, Math.min(y + h, height) - top];
  }
}
