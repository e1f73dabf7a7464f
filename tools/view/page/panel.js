// SPDX-License-Identifier: BSD-3-Clause
// Everything that is said in words and figures.

import { clamp, quantile, rollPitchYaw, rotationOf } from "./math.js";
import { STATUSES } from "./protocol.js";

const WORDS = { initializing: "Initializing", tracking: "Tracking", degraded: "Degraded", lost: "Lost" };
const MEANINGS = {
  initializing: "No map yet, or not sure of the first motion.",
  tracking: "Aligned with the map.",
  degraded: "Aligned, but not surely: held to the prediction in some direction, data were missing, it fits poorly, its motion is in doubt, or its last 10 m are uncertain.",
  lost: "Not aligned: the pose is the prediction alone.",
};
/** Of health: why there are no poses. */
const REASONS = {
  silent: "No packet comes from the sensor: cable, power, its destination address.",
  no_scans: "Packets come, but no revolution ends.",
  no_poses: "Scans wait, but no pose comes.",
};
const DIRECTIONS = ["forward", "sideways", "height", "roll", "pitch", "yaw"];
const CLOCKS = { gps: "GPS", host: "this computer's hour", replay: "recorded" };
const SILENT_S = 0.7; // without a pose: seven scans at 10 Hz
const LATENCIES = 600;

const $ = (id) => document.getElementById(id);
const set = (id, text) => { if ($(id).textContent !== text) $(id).textContent = text; };
const grouped = (n) => Math.round(n).toString().replace(/\B(?=(\d{3})+$)/g, "\u202f");
const degrees = (rad) => (rad * 180) / Math.PI;
/** To so many decimals, and never "-0.0". */
const fixed = (v, digits) => (Number(v.toFixed(digits)) + 0).toFixed(digits);

/** Status, title and explanation: what a robot's operator needs to know first. */
export function stateOf(source, store, frame, isLive) {
  const now = performance.now();
  if (!source.connected) return ["none", "No connection", "lilo view does not answer. Trying again."];
  if (source.view.error) return ["lost", "Stopped", source.view.error];
  if (isLive && source.view.mode === "live") {
    if (!source.view.answers && now - Math.max(store.healthAt, store.poseAt) > 1000) {
      return ["lost", "No answer", `lilod does not answer at ${source.view.name}.`];
    }
    const silent_s = (now - store.poseAt) / 1000;
    if (!frame || silent_s > SILENT_S) {
      const since = frame ? `The last pose came ${silent_s.toFixed(0)} s ago. ` : "Waiting for the sensor. ";
      return ["lost", "No poses", since + (REASONS[store.health && store.health.status] || "")];
    }
  }
  if (!frame) return ["none", "Reading", "The odometry is at work."];
  const status = STATUSES[frame.status];
  return [status, WORDS[status], MEANINGS[status]];
}

export function drawPanel(source, store, player) {
  const frame = store.frames[player.at];
  const [status, word, meaning] = stateOf(source, store, frame, player.live);
  $("status").dataset.status = status;
  set("word", word);
  set("meaning", meaning);
  document.title = `${word} · lilo view`;
  drawComplaints(source, store, frame, player);
  if (frame) drawFigures(store, frame, player);
  drawHealth(source, store, player);
  set("source", sourceText(source));
}

function drawComplaints(source, store, frame, player) {
  const complaints = player.live && store.health ? [...store.health.complaints] : [];
  for (const weak of frame ? frame.weak : []) {
    const k = weak.direction.reduce((best, v, n, all) => (Math.abs(v) > Math.abs(all[best]) ? n : best), 0);
    complaints.push(`little to align by: ${DIRECTIONS[k]}, ${Math.round(100 * weak.fromScan)} % from the scan`);
  }
  if (frame && frame.lost > 0) complaints.push(`${frame.lost} packets of this scan lost`);
  if (source.view.mode === "live" && source.view.points === false) {
    complaints.push("no points: lilod grants none (subscribe.points_clients)");
  }
  const text = complaints.join("\n");
  if ($("complaints").dataset.text === text) return;
  $("complaints").dataset.text = text;
  $("complaints").replaceChildren(...complaints.map((line) => {
    const item = document.createElement("li");
    item.textContent = line;
    return item;
  }));
}

function drawFigures(store, frame, player) {
  set("speed", frame.speed === null ? "–" : `${frame.speed.toFixed(1)} m/s`);
  set("driven", frame.distance < 1000 ? `${frame.distance.toFixed(1)} m` : `${(frame.distance / 1000).toFixed(2)} km`);
  set("position", frame.position.map((v) => fixed(v, 2)).join("  ") + " m");
  set("angles", rollPitchYaw(rotationOf(frame.rotation)).map((v) => fixed(degrees(v), 1)).join("°  ") + "°");
  const c = frame.covariance;
  set("sigma", c ? `${Math.sqrt(Math.max(c[0] + c[7] + c[14], 0)).toFixed(2)} m, ` +
    `${degrees(Math.sqrt(Math.max(c[21] + c[28] + c[35], 0))).toFixed(2)}°` : "–");
  set("missed", grouped(frame.session.missed));
  const of = store.sessions.length > 1 ? `${frame.session.number} of ${store.sessions[store.sessions.length - 1].number}, ` : "";
  set("session", `${of}${frame.session.id}`);
  const rate = rateAt(store, player.at);
  if (!player.live || !store.health) set("rate", rate ? `${rate.toFixed(1)} Hz` : "–");
}

function rateAt(store, at) {
  const frame = store.frames[at], from = store.frames[Math.max(frame.session.first, at - 10)];
  const span = frame.time - from.time;
  return span > 0 ? (at - store.frames.indexOf(from, Math.max(0, at - 10))) / span : 0;
}

function drawHealth(source, store, player) {
  const h = store.health;
  if (!h) return;
  if (player.live) set("rate", `${h.rate_hz.toFixed(1)} Hz`);
  const all = h.packets.received + h.packets.lost;
  const share = all > 0 ? (100 * h.packets.lost) / all : 0;
  set("packets", h.packets.lost === 0 ? "none" : `${grouped(h.packets.lost)} (${share.toPrecision(2)} %)`);
  set("scans", h.scans.dropped === 0 ? "none" : grouped(h.scans.dropped));
  set("clock", CLOCKS[h.clock] || h.clock);
  const busy = h.cpu_percent ?? (h.processing_ms.p50 * h.rate_hz) / 10;
  set("cpu", `${h.processing_ms.p50.toFixed(1)} ms a scan, ${busy.toFixed(0)} %`);
  set("memory", `${h.realtime.resident_mb.toFixed(0)} MiB`);
}

function sourceText(source) {
  const { view } = source;
  if (!view.mode) return "";
  const thinned = view.thinned ? ". The past is thinned out" : "";
  if (view.mode === "live") return `Live from lilod at ${view.name}${thinned}`;
  return `Recording ${view.name}${view.done ? "" : `, ${Math.round(100 * view.progress)} % read`}${thinned}`;
}

/** The last minute of latencies before what is shown, and their p99. */
export function drawSpark(store, at, isRecording, style) {
  const canvas = $("spark"), context = canvas.getContext("2d");
  const width = canvas.clientWidth * 2, height = canvas.clientHeight * 2;
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
  context.clearRect(0, 0, width, height);
  const frames = store.frames.slice(Math.max(0, at - LATENCIES + 1), at + 1);
  set("latency_name", isRecording ? "Time a scan" : "Latency");
  if (frames.length < 2) return;
  const values = frames.map((f) => f.latency), p99 = quantile(values, 0.99);
  const top = niceAbove(1.3 * p99);
  const y = (v) => height - 3 - clamp(v / top, 0, 1) * (height - 6);
  const x = (k) => width - ((frames.length - 1 - k) * width) / (LATENCIES - 1);
  context.strokeStyle = style.line;
  context.lineWidth = 2;
  context.setLineDash([6, 6]);
  context.beginPath();
  context.moveTo(0, y(p99));
  context.lineTo(width, y(p99));
  context.stroke();
  context.setLineDash([]);
  context.strokeStyle = style.curve;
  context.beginPath();
  values.forEach((v, k) => context.lineTo(x(k), y(v)));
  context.stroke();
  set("latency", `${values[values.length - 1].toFixed(1)} ms`);
  set("p99", `p99 ${p99.toFixed(1)} ms, top ${top} ms`);
  set("spark_span", `last ${frames.length} poses`);
}

/** 1, 2 or 5 times a power of ten, so that the scale changes rarely. */
function niceAbove(value) {
  const power = 10 ** Math.floor(Math.log10(Math.max(value, 1e-3)));
  const step = [1, 2, 5, 10].find((s) => s * power >= value);
  return Number((step * power).toPrecision(1));
}
