// Copyright 2026 het_ros maintainers
// SPDX-License-Identifier: Apache-2.0
// The socket: connects again by itself, and knows how this clock differs from the server's.

const FIRST_WAIT = 500; // ms before another try
const LONGEST_WAIT = 4000;
const PING = 3000;
const SILENCE = 8000; // ms without a message after which the link is taken for dead

/** Keep the token of the address out of sight and history, and at hand for a reload. */
function takeToken() {
  const given = new URLSearchParams(location.hash.slice(1)).get("token");
  if (given !== null) {
    sessionStorage.setItem("token", given);
    history.replaceState(null, "", location.pathname);
  }
  return sessionStorage.getItem("token") ?? "";
}

/** Emits "open", "closed" (detail: why) and one event for each type of message. */
export class Connection extends EventTarget {
  #socket = null;
  #wait = FIRST_WAIT;
  #offset = 0;
  #shortest = Infinity;
  #heard = 0;
  #token = takeToken();

  constructor() {
    super();
    setInterval(() => this.#ping(), PING);
    this.#connect();
  }

  /** The server's time, s since 1970. */
  now() {
    return (performance.timeOrigin + performance.now()) / 1000 + this.#offset;
  }

  send(type, fields = {}) {
    if (this.#socket?.readyState !== WebSocket.OPEN) return false;
    this.#socket.send(JSON.stringify({ type, ...fields }));
    return true;
  }

  #connect() {
    const address = new URL(`socket?token=${encodeURIComponent(this.#token)}`, location.href);
    address.protocol = address.protocol.replace("http", "ws");
    const socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    socket.onopen = () => {
      this.#wait = FIRST_WAIT;
      this.#shortest = Infinity;
      this.#heard = performance.now();
      this.#emit("open");
      this.#ping();
    };
    socket.onmessage = ({ data }) => {
      this.#heard = performance.now();
      if (typeof data === "string") this.#onText(JSON.parse(data));
      else this.#onImage(data);
    };
    socket.onclose = () => this.#onClose(socket);
  }

  async #onClose(socket) {
    if (socket !== this.#socket) return;
    this.#socket = null;
    setTimeout(() => this.#connect(), this.#wait);
    this.#wait = Math.min(this.#wait * 2, LONGEST_WAIT);
    let why = "no connection";
    try {
      const asked = await fetch(`check?token=${encodeURIComponent(this.#token)}`);
      if (!asked.ok) why = await asked.text();
    } catch {
      why = "the operator's server is away";
    }
    if (this.#socket?.readyState !== WebSocket.OPEN) this.#emit("closed", why);
  }

  #ping() {
    if (this.#socket?.readyState !== WebSocket.OPEN) return;
    if (performance.now() - this.#heard > SILENCE) {
      const dead = this.#socket;
      dead.close();
      this.#onClose(dead);
      return;
    }
    this.send("ping", { time: performance.now() });
  }

  #onText(message) {
    if (message.type === "pong") this.#onPong(message);
    else this.#emit(message.type, message);
  }

  /** The shortest way there and back tells the clocks' difference best. */
  #onPong({ time, now }) {
    const back = performance.now();
    const way = (back - time) / 1000;
    if (way < this.#shortest) {
      this.#shortest = way;
      this.#offset = now + way / 2 - (performance.timeOrigin + back) / 1000;
    }
  }

  async #onImage(data) {
    const length = new DataView(data).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    const jpeg = new Blob([new Uint8Array(data, 4 + length)], { type: "image/jpeg" });
    try {
      const bitmap = await createImageBitmap(jpeg, { imageOrientation: "none" });
      this.#emit("image", { ...head, bitmap });
    } finally {
      this.send("shown");
    }
  }

  #emit(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}
