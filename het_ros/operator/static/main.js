// Copyright 2026 het_ros maintainers
// SPDX-License-Identifier: Apache-2.0
// Puts the page together: what comes over the socket to where it is shown, and back.

import { Connection } from "./connection.js";
import { $, Figures, say, showParameters, showRecording, showTrackers } from "./panel.js";
import { Pick } from "./pick.js";
import { Strip } from "./strip.js";
import { View } from "./view.js";

const GOOD_EVERY = 500; // ms between two pictures of the target that are kept
const NO_PICTURE = 3000; // ms after which the page says that none comes
const WITH_BOX = ["TRACKING", "COASTING"];

const link = new Connection();
const figures = new Figures();
const strip = new Strip($("strip"), $("at"));
const view = new View($("live"), (image) => figures.drawn(1000 * (link.now() - image.captured)));
let tracker = sessionStorage.getItem("tracker") ?? "";
let state = "";
let goodAt = 0;
let pictureAt = 0;
let from = ""; // topic of the camera
let there = false; // whether the tracker is in the graph
let answered = null; // waits for the answer to a pick
let audio = null;

const pick = new Pick($("live"), view, {
  onFreeze: (on) => link.send("freeze", { on }),
  onChange: showPick,
  isDirect: () => $("direct").checked,
  send: sendBox,
});

function showPick() {
  $("picking").hidden = !pick.active || !view.box;
  if (view.box) {
    const [x, y, w, h] = view.box.map(Math.round);
    $("size").textContent = `${w} x ${h} px at ${x}, ${y}`;
  }
  showHint();
}

function showHint() {
  const silent = performance.now() - pictureAt > NO_PICTURE;
  let text = "Drag a box around the target, or press P.";
  if (pick.active) text = "Frozen. Move the box, its edges or corners; Enter starts the track on this picture.";
  else if (!tracker) text = "No tracker is found in this ROS domain yet.";
  else if (silent) text = from ? `No picture comes on ${from}.` : `${tracker}: its camera is not known yet.`;
  else if (WITH_BOX.includes(state)) text = "Following. Drag a box to follow something else.";
  if ($("hint").textContent !== text) $("hint").textContent = text;
}
setInterval(showHint, 500);

async function sendBox(box, stamp) {
  let replace = false;
  if (WITH_BOX.includes(state)) {
    if (!(await askToReplace())) return false;
    replace = true;
  }
  let answer = await request({ box, stamp, replace });
  if (!answer.ok && !replace && answer.text.includes("replace") && (await askToReplace()))
    answer = await request({ box, stamp, replace: true });
  if (!answer.ok) say(answer.text, true);
  return answer.ok;
}

function request(fields) {
  return new Promise((resolve) => {
    answered = resolve;
    if (!link.send("pick", fields)) resolve({ ok: false, text: "not connected: the box is not sent" });
  });
}

function askToReplace() {
  const dialog = $("replace");
  return new Promise((resolve) => {
    dialog.returnValue = "no";
    dialog.onclose = () => resolve(dialog.returnValue === "yes");
    dialog.showModal();
  });
}

function look() {
  const width = Math.round($("live").clientWidth * devicePixelRatio);
  const rounded = Math.min(Math.max(width, 160), 4096);
  link.send("view", { tracker, width: rounded, quality: rounded < 700 ? 60 : 75 });
}

function choose(name) {
  if (name === tracker) return;
  tracker = name;
  sessionStorage.setItem("tracker", name);
  pick.letGo();
  view.clear();
  figures.clear();
  strip.clear();
  from = "";
  showState("NONE", "");
  look();
}

function showState(next, reason) {
  if (next === "LOST" && state !== "LOST") beep();
  state = next;
  document.body.dataset.state = next;
  const word = next === "NONE" ? "no track" : next;
  if ($("state").textContent !== word) $("state").textContent = word;
  if ($("reason").textContent !== reason) $("reason").textContent = reason;
  if ($("lost").hidden !== (next !== "LOST")) $("lost").hidden = next !== "LOST";
  if (next === "LOST" && $("lost-why").textContent !== reason) $("lost-why").textContent = reason;
}

/** Keep what the target looks like now; shown when it is lost. */
function keepGood(track) {
  const image = view.image;
  if (!image || performance.now() - goodAt < GOOD_EVERY) return;
  goodAt = performance.now();
  const [x, y, w, h] = track.box;
  const side = 1.3 * Math.max(w, h);
  const shrink = image.bitmap.width / image.size[0];
  const [left, top] = [x + w / 2 - side / 2, y + h / 2 - side / 2];
  const pen = $("good").getContext("2d");
  pen.clearRect(0, 0, 120, 120);
  pen.drawImage(image.bitmap, ...[left, top, side, side].map((part) => part * shrink), 0, 0, 120, 120);
}

function beep() {
  if (!audio) return;
  const tone = audio.createOscillator();
  const volume = audio.createGain();
  volume.gain.value = 0.2;
  tone.frequency.value = 660;
  tone.connect(volume).connect(audio.destination);
  tone.start();
  tone.stop(audio.currentTime + 0.4);
}

const on = (type, react) => link.addEventListener(type, ({ detail }) => react(detail));
function showLink(text, ok) {
  $("link").textContent = text;
  $("link").dataset.ok = ok;
}

on("open", () => {
  showLink("connected", true);
  look();
});
on("closed", (why) => {
  showLink(why, false);
  answered?.({ ok: false, text: "the connection broke: the box may not have come through" });
});
on("trackers", ({ names, images }) => {
  choose(showTrackers(names, tracker));
  if (names.includes(tracker) && !there) look(); // it has come: ask for its parameters
  there = names.includes(tracker);
  from = images;
});
on("image", (image) => {
  pictureAt = performance.now();
  figures.came(image.number);
  view.addImage(image);
});
on("track", (track) => {
  view.addTrack(track);
  strip.add(track);
  showState(track.state, track.reason);
  $("score").textContent = track.score.toFixed(2);
  $("work").textContent = `${track.latency_ms.toFixed(0)} ms`;
  if (track.state === "TRACKING" && track.box) keepGood(track);
});
on("log", ({ warning, text }) => say(text, warning));
on("answer", (answer) => {
  if (answer.to === "pick") answered?.(answer);
  else say(answer.text, !answer.ok);
  if (answer.to === "enable" && !answer.ok) pause(false);
});
on("recording", showRecording);
on("parameters", ({ parameters }) =>
  showParameters(parameters, (name, value) => link.send("set", { name, value })),
);

function pause(wanted) {
  $("pause").setAttribute("aria-pressed", wanted);
  $("pause").textContent = wanted ? "Go on" : "Pause";
}
const pressed = (id) => $(id).getAttribute("aria-pressed") === "true";

$("trackers").addEventListener("change", ({ target }) => choose(target.value));
$("reset").addEventListener("click", () => link.send("reset"));
$("pick").addEventListener("click", () => pick.begin());
$("again").addEventListener("click", () => pick.begin());
$("send").addEventListener("click", () => pick.send());
$("cancel").addEventListener("click", () => pick.letGo());
$("pause").addEventListener("click", () => {
  const wanted = !pressed("pause");
  if (link.send("enable", { on: !wanted })) pause(wanted);
});
$("record").addEventListener("click", () => link.send("record", { on: !pressed("record") }));
$("sound").addEventListener("change", ({ target }) => {
  audio = target.checked ? new AudioContext() : null;
  beep();
});
$("parameters").addEventListener("submit", (event) => event.preventDefault());

document.addEventListener("keydown", (event) => {
  const others = event.key === "Escape" ? "dialog" : "input, select, button, dialog, summary";
  if (event.target.closest(others)) return;
  const mine = pick.key(event);
  const plain = !mine && !event.ctrlKey && !event.altKey && !event.metaKey;
  if (plain && event.key === "p") pick.begin();
  else if (plain && event.key === "r") link.send("reset");
  else if (!mine) return;
  event.preventDefault();
});
new ResizeObserver(() => look()).observe($("live"));

globalThis.operatorPage = { figures, view, pick, link }; // for tests and measurements
