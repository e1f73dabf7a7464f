// SPDX-License-Identifier: BSD-3-Clause
// Joins the stream, the store and what is seen of it.

import { Camera } from "./camera.js";
import { project, quantile, rollPitchYaw, rotationOf } from "./math.js";
import { Measure } from "./measure.js";
import { drawPanel, drawSpark } from "./panel.js";
import { drawStrip, Player } from "./player.js";
import { readLines } from "./protocol.js";
import { HEIGHT_COLORS, Scene, STATUS_COLORS } from "./scene.js";
import { MOST_POINTS, Store } from "./store.js";

const $ = (id) => document.getElementById(id);
const SLOW_MS = 40; // a frame: above it fewer points are drawn
const PANEL_EVERY_MS = 100;

const store = new Store();
const player = new Player(store);
const camera = new Camera();
const measure = new Measure();
const source = { connected: false, view: {} };
const options = { scan: true, measured: measure.points };
const frameTimes = [];
let scene, dirty = true, resting = 0, last = performance.now(), shown = null, socket;

/** Until the server is there, and again whenever it went. It tells the whole past each time. */
function connect() {
  socket = new WebSocket(`ws://${location.host}/stream`);
  socket.onopen = () => {
    store.clear();
    source.connected = true;
  };
  socket.onmessage = ({ data }) => {
    readLines(data, {
      pose: (pose) => store.addPose(pose),
      points: (points) => store.addPoints(points),
      health: (health) => store.setHealth(health),
      view: setView,
      answer: (text) => { $("answer").textContent = text; },
    });
    dirty = true;
  };
  socket.onclose = () => {
    source.connected = false;
    setTimeout(connect, 1000);
  };
}

function setView(view) {
  const first = !source.view.mode;
  source.view = view;
  player.more = view.mode === "recording" && !view.done;
  $("live").hidden = view.mode !== "live";
  $("control").hidden = !view.control || !controlToken();
  // A recording is watched from its beginning, a robot as it is.
  if (first && view.mode === "recording") {
    player.live = false;
    player.playing = true;
  }
}

/** Behind the # of the link: it never leaves the browser but for a command. */
function controlToken() {
  const given = new URLSearchParams(location.hash.slice(1)).get("control");
  if (given) sessionStorage.setItem("control", given);
  return sessionStorage.getItem("control");
}

function sendCommand(name) {
  if (name === "reset" && !confirm("Begin a new session at the origin?")) return;
  const request = name === "reset" ? { reset: {} } : { save: name };
  socket.send(JSON.stringify({ token: controlToken(), request }));
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  scene.theme = theme;
  $("theme").textContent = theme === "dark" ? "Light" : "Dark";
  localStorage.setItem("theme", theme);
  const bar = $("colorbar").getContext("2d"), gradient = bar.createLinearGradient(0, 0, 140, 0);
  HEIGHT_COLORS[theme].forEach((color, k, all) => gradient.addColorStop(k / (all.length - 1), color));
  bar.fillStyle = gradient;
  bar.fillRect(0, 0, 140, 10);
  dirty = true;
}

function setMode(mode) {
  camera.setMode(mode);
  for (const button of document.querySelectorAll("[data-mode]")) {
    button.setAttribute("aria-pressed", button.dataset.mode === mode);
  }
  dirty = true;
}

/** All of the map shown but for its stragglers, and the pose. */
function fit() {
  const frame = store.frames[player.at];
  if (!frame) return;
  const { positions } = frame.session.map;
  const step = 3 * Math.max(1, Math.floor(frame.mapCount / 10000));
  const ends = [0, 1, 2].map((k) => {
    const values = [frame.position[k]];
    for (let n = k; n < 3 * frame.mapCount; n += step) values.push(positions[n]);
    return [quantile(values, 0.03), quantile(values, 0.97)];
  });
  setMode("free");
  camera.fit(ends.map(([low, high]) => (low + high) / 2), Math.hypot(...ends.map(([low, high]) => (high - low) / 2)));
}

function toggleMeasure() {
  measure.toggle();
  options.measured = measure.points;
  document.body.classList.toggle("measuring", measure.active);
  $("measure").setAttribute("aria-pressed", measure.active);
  dirty = true;
}

function pick(event) {
  const frame = store.frames[player.at], box = $("canvas").getBoundingClientRect();
  if (!frame || !scene.view) return;
  const x = (2 * (event.clientX - box.left)) / box.width - 1;
  const y = 1 - (2 * (event.clientY - box.top)) / box.height;
  measure.pick(frame.session.map, frame.mapCount, scene.view, x, y, box.width, box.height);
  options.measured = measure.points;
  dirty = true;
}

/** One finger or button turns; two, the right one or shift move. A click that did not move picks. */
function watchPointers(canvas) {
  const held = new Map();
  let moved = 0;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, [event.clientX, event.clientY]);
    moved = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    const from = held.get(event.pointerId);
    if (!from) return;
    const [dx, dy] = [event.clientX - from[0], event.clientY - from[1]], h = canvas.clientHeight;
    moved += Math.abs(dx) + Math.abs(dy);
    const others = [...held.entries()].filter(([id]) => id !== event.pointerId);
    held.set(event.pointerId, [event.clientX, event.clientY]);
    if (others.length > 0) {
      const other = others[0][1], span = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
      camera.zoom(span(from) / Math.max(span([event.clientX, event.clientY]), 1));
      camera.pan(dx / (2 * h), -dy / (2 * h));
    } else if (event.buttons & 2 || event.shiftKey) {
      camera.pan(dx / h, -dy / h);
    } else {
      camera.orbit((3 * dx) / h, (3 * dy) / h);
    }
    dirty = true;
  });
  const release = (event) => {
    if (held.delete(event.pointerId) && measure.active && moved < 5 && event.type === "pointerup") pick(event);
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoom(Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100) * 0.002));
    dirty = true;
  }, { passive: false });
}

const KEYS = {
  1: () => setMode("follow"), 2: () => setMode("free"), 3: () => setMode("top"),
  " ": () => player.toggle(),
  ArrowLeft: (event) => player.seek(player.at - (event.shiftKey ? 10 : 1)),
  ArrowRight: (event) => player.seek(player.at + (event.shiftKey ? 10 : 1)),
  l: () => player.goLive(), f: fit, m: toggleMeasure,
  Escape: () => measure.active && toggleMeasure(),
  p: () => { options.scan = !options.scan; },
  t: () => setTheme(scene.theme === "dark" ? "light" : "dark"),
  "?": () => $("keys").showModal(),
  "+": () => camera.zoom(0.8), "-": () => camera.zoom(1.25),
  w: () => camera.pan(0, -0.05), s: () => camera.pan(0, 0.05),
  a: () => camera.pan(0.05, 0), d: () => camera.pan(-0.05, 0),
};

function watchControls() {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || $("keys").open) return;
    if (event.target.tagName === "SELECT") return;
    if (event.target.tagName === "BUTTON" && (event.key === " " || event.key === "Enter")) return;
    const act = KEYS[event.key] || KEYS[event.key.toLowerCase()];
    if (!act) return;
    event.preventDefault();
    act(event);
    dirty = true;
  });
  for (const button of document.querySelectorAll("[data-mode]")) button.onclick = () => setMode(button.dataset.mode);
  for (const button of document.querySelectorAll("[data-request]")) button.onclick = () => sendCommand(button.dataset.request);
  $("fit").onclick = fit;
  $("measure").onclick = toggleMeasure;
  $("theme").onclick = KEYS.t;
  $("help").onclick = KEYS["?"];
  $("play").onclick = () => player.toggle();
  $("live").onclick = () => player.goLive();
  $("slider").oninput = () => player.seek(Number($("slider").value));
  $("speed_factor").onchange = () => { player.speed = Number($("speed_factor").value); };
  window.addEventListener("resize", () => { dirty = true; });
}

function drawTimeline(style) {
  const count = store.frames.length;
  if (Number($("slider").max) !== Math.max(count - 1, 0)) $("slider").max = Math.max(count - 1, 0);
  if (Number($("slider").value) !== player.at) $("slider").value = player.at;
  const running = player.playing || (player.live && source.view.mode === "live");
  $("play").textContent = running ? "❚❚" : "▶";
  $("play").setAttribute("aria-label", running ? "Pause" : "Play");
  $("live").setAttribute("aria-pressed", player.live);
  drawStrip($("strip"), store, STATUS_COLORS[scene.theme], style.text);
  const frame = store.frames[player.at];
  $("clock_text").textContent = frame ? clockText(frame.time) : "–";
}

/** UTC, or seconds where a recording counts from its own start. */
function clockText(time) {
  if (time < 3e7) return `${time.toFixed(1)} s`;
  return `${new Date(time * 1000).toISOString().slice(11, 21)} UTC`;
}

function drawLegend() {
  const heights = scene.drawn && scene.drawn.heights;
  const text = (v) => (Number(v.toFixed(1)) + 0).toFixed(1);
  $("low").textContent = heights ? text(heights[0]) : "–";
  $("high").textContent = heights ? text(heights[1]) : "–";
  $("grid").textContent = `grid ${scene.gridStep || "–"} m`;
}

/** What is drawn, and what is left out. */
function drawDrawing() {
  const frame = store.frames[player.at];
  if (!frame) return;
  const { map } = frame.session, lines = [];
  if (map.version > 0) lines.push(`map thinned: ${MOST_POINTS.toLocaleString("en")} points is the most; one each ${map.voxel.toFixed(2)} m`);
  if (scene.stride > 1) lines.push(`drawing is slow here: 1 of ${scene.stride} points is drawn`);
  lines.push(`${frame.mapCount.toLocaleString("en")} points`);
  $("drawing").textContent = lines.join("\n");
}

function drawLabel() {
  const { text } = measure, label = $("label");
  label.hidden = text === "";
  if (label.hidden) return;
  label.textContent = text;
  const canvas = $("canvas"), end = measure.points[measure.points.length - 1];
  const [x, y, w] = end && measure.points.length === 2 ? project(scene.view.matrix, end) : [0, 0.9, 1];
  label.hidden = w <= 0;
  label.style.left = `${((x + 1) / 2) * canvas.clientWidth}px`;
  label.style.top = `${((1 - y) / 2) * canvas.clientHeight + (measure.points.length === 2 ? 0 : 40)}px`;
}

/** By the clock and not with the pictures: where these are slow, a loss is still told at once. */
function drawWords() {
  const css = getComputedStyle(document.documentElement);
  const style = { text: css.getPropertyValue("--text"), line: css.getPropertyValue("--dim"),
    curve: css.getPropertyValue("--tracking") };
  drawPanel(source, store, player);
  drawSpark(store, player.at, source.view.mode === "recording", style);
  drawTimeline(style);
  drawLegend();
  drawDrawing();
}

/** Fewer points where the machine is too slow, all again where it is fast enough. */
function adapt(dt) {
  frameTimes.push(dt);
  const sum = frameTimes.reduce((a, b) => a + b);
  if (frameTimes.length < 4 || sum < 500) return;
  const mean = sum / frameTimes.length;
  frameTimes.length = 0;
  if (mean > SLOW_MS && scene.stride < 16) scene.stride *= 2;
  else if (mean < SLOW_MS / 3 && scene.stride > 1) scene.stride /= 2;
}

function tick(now) {
  const dt = now - last;
  last = now;
  const at = player.advance(dt / 1000), frame = store.frames[at];
  const heading = frame ? rollPitchYaw(rotationOf(frame.rotation))[2] : 0;
  const moving = camera.approach(frame && frame.position, heading, dt / 1000);
  resting = moving ? 0 : resting + 1;
  const drawn = dirty || moving || at !== shown || scene.resize();
  if (drawn) {
    dirty = false;
    shown = at;
    scene.resize();
    scene.draw(store, at, camera, options);
    drawLabel();
    if (dt < 1000) adapt(dt);
  }
  requestAnimationFrame(tick);
}

/** Once the camera rests and all that is said is up to date. */
async function settled() {
  const drawn = () => new Promise((done) => requestAnimationFrame(done));
  do {
    dirty = true;
    await drawn();
    await drawn();
  } while (resting < 2);
  drawWords();
}

function begin() {
  try {
    scene = new Scene($("canvas"));
  } catch (error) {
    $("word").textContent = "No picture";
    $("meaning").textContent = error.message;
    return;
  }
  const light = window.matchMedia("(prefers-color-scheme: light)").matches;
  setTheme(localStorage.getItem("theme") || (light ? "light" : "dark"));
  watchPointers($("canvas"));
  watchControls();
  connect();
  requestAnimationFrame(tick);
  setInterval(drawWords, PANEL_EVERY_MS);
  // For the console, and for the tests.
  window.lilo = { store, player, camera, scene, source, measure, setMode, setTheme, fit,
    settled, drawNow: () => scene.draw(store, player.at, camera, options) };
}

begin();
