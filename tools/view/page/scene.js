// SPDX-License-Identifier: BSD-3-Clause
// Draws the store as it was at one frame.

import { add, quantile, rotationOf, scale, symmetricEigen, turned } from "./math.js";
import { compile, LINES, POINTS } from "./shaders.js";

const FLOATS_OF_LINE = 12; // from, to, color
const SCAN_COLOR = { dark: [1, 1, 1], light: [0.85, 0.1, 0.45] };

/** Heights, lowest first: dark blue to yellow, as light as the background allows. */
export const HEIGHT_COLORS = {
  dark: ["#3b4cc0", "#3f77d8", "#3aa3d0", "#36c0a8", "#6ccb5f", "#b5d441", "#f0d03c", "#fca636"],
  light: ["#30306e", "#31548f", "#2a788e", "#22948a", "#3a9d5b", "#7a9a1d", "#b48a05", "#c65b00"],
};
/** By STATUSES of protocol.js, then what is missing. */
export const STATUS_COLORS = {
  dark: ["#b18cff", "#35c46f", "#ffb020", "#ff5a52", "#8a919c"],
  light: ["#7a3ff2", "#0a8f48", "#c77700", "#d3211c", "#7b8290"],
};

const rgb = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255);
const AXIS_COLORS = ["#e5484d", "#30a46c", "#3e7bfa"].map(rgb);

/** A buffer on the card that grows with an array whose beginning does not change. */
class GrowingBuffer {
  constructor(gl) {
    this.gl = gl;
    this.buffer = gl.createBuffer();
    this.capacity = 0; // floats
    this.filled = 0;
  }

  /** `array` as far as `floats`; `fresh`: all of it has changed. */
  upload(array, floats, fresh) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    if (fresh || floats < this.filled) this.filled = 0;
    if (floats > this.capacity) {
      this.capacity = Math.max(2 * floats, 65536);
      gl.bufferData(gl.ARRAY_BUFFER, 4 * this.capacity, gl.DYNAMIC_DRAW);
      this.filled = 0;
    }
    if (floats > this.filled) {
      gl.bufferSubData(gl.ARRAY_BUFFER, 4 * this.filled, array.subarray(this.filled, floats));
    }
    this.filled = floats;
  }
}

/** What of a session is on the card, and the heights its colours span. */
class Drawn {
  constructor(gl, session) {
    this.session = session;
    this.map = new GrowingBuffer(gl);
    this.track = new GrowingBuffer(gl);
    this.trackArray = new Float32Array(4096);
    this.frames = 0;
    this.storeVersion = this.mapVersion = -1;
    this.heights = null;
    this.sampledAt = 0;
  }

  free(gl) {
    gl.deleteBuffer(this.map.buffer);
    gl.deleteBuffer(this.track.buffer);
  }
}

export class Scene {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.gl = gl;
    this.points = compile(gl, POINTS);
    this.lines = compile(gl, LINES);
    this.lineArray = new Float32Array(FLOATS_OF_LINE * 1024);
    this.lineCount = 0;
    this.lineBuffer = gl.createBuffer();
    this.scanBuffer = gl.createBuffer();
    this.drawn = null;
    this.stride = 1; // of the map's points, only every so manieth is drawn
    this.theme = "dark";
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  /** To the size of its place on the page, in real pixels; true when that has changed. */
  resize() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (width === this.canvas.width && height === this.canvas.height) return false;
    this.canvas.width = width;
    this.canvas.height = height;
    this.gl.viewport(0, 0, width, height);
    return true;
  }

  get aspect() { return this.canvas.width / this.canvas.height; }

  /** `at`: index of the frame in the store; `measured`: points to be joined. */
  draw(store, at, camera, options) {
    const { gl } = this;
    const background = rgb(this.theme === "dark" ? "#0e1116" : "#fbfbf9");
    gl.clearColor(...background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const view = camera.view(this.aspect);
    this.view = view;
    this.lineCount = 0;
    const frame = store.frames[at];
    if (frame) this.follow(store, frame.session);
    this.addGrid(camera, view, frame);
    this.drawLines(view, 1, gl.LEQUAL);
    if (!frame) return;
    this.drawMap(view, frame);
    if (options.scan && frame.scan) this.drawScan(view, frame);
    this.drawTrack(view, at - frame.session.first + 1);
    this.lineCount = 0;
    this.addPose(frame, view);
    this.drawLines(view, 2.5, gl.ALWAYS);
    this.lineCount = 0;
    for (let k = 1; k < options.measured.length; ++k) {
      this.addLine(options.measured[k - 1], options.measured[k], rgb("#ff2bd6"), 1);
    }
    this.drawLines(view, 3, gl.ALWAYS);
  }

  /** Uploads what is new of the session. */
  follow(store, session) {
    const { gl } = this;
    if (!this.drawn || this.drawn.session !== session) {
      if (this.drawn) this.drawn.free(gl);
      this.drawn = new Drawn(gl, session);
    }
    const d = this.drawn, { map } = session;
    d.map.upload(map.positions, 3 * map.count, d.mapVersion !== map.version);
    d.mapVersion = map.version;
    this.followHeights(d, map);
    this.followTrack(d, store);
  }

  /** All but the lowest and the highest hundredth. They go there slowly, so that no colour jumps. */
  followHeights(d, map) {
    const now = performance.now();
    if (d.heights && now - d.sampledAt < 500) return;
    if (map.count < 50) return;
    d.sampledAt = now;
    const sample = [], step = 3 * Math.max(1, Math.floor(map.count / 5000));
    for (let n = 2; n < 3 * map.count; n += step) sample.push(map.positions[n]);
    const low = quantile(sample, 0.01), high = Math.max(quantile(sample, 0.99), low + 1);
    const s = d.heights ? 0.2 : 1;
    const from = d.heights || [low, high];
    d.heights = [from[0] + s * (low - from[0]), from[1] + s * (high - from[1])];
    d.ground = quantile(sample, 0.1);
  }

  followTrack(d, store) {
    const next = store.sessions[store.sessions.indexOf(d.session) + 1];
    const end = next ? next.first : store.frames.length;
    const fresh = d.storeVersion !== store.version;
    if (fresh) d.frames = 0;
    d.storeVersion = store.version;
    const count = end - d.session.first;
    if (4 * count > d.trackArray.length) {
      const larger = new Float32Array(8 * count);
      larger.set(d.trackArray);
      d.trackArray = larger;
    }
    for (let k = d.frames; k < count; ++k) {
      const f = store.frames[d.session.first + k];
      d.trackArray.set([...f.position, f.status + (f.gap ? 8 : 0)], 4 * k);
    }
    d.frames = count;
    d.track.upload(d.trackArray, 4 * count, fresh);
  }

  usePoints(view, size, smallest, heights, single) {
    const { gl } = this, { program, uniforms } = this.points;
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.matrix, false, view.matrix);
    const perMetre = view.isFlat ? this.canvas.height / view.height : this.canvas.height;
    gl.uniform1f(uniforms.size, size * perMetre);
    gl.uniform1f(uniforms.smallest, smallest * Math.min(window.devicePixelRatio || 1, 2));
    gl.uniform2fv(uniforms.heights, heights);
    gl.uniform3fv(uniforms.colors, HEIGHT_COLORS[this.theme].flatMap(rgb));
    gl.uniform4fv(uniforms.single, single);
  }

  drawMap(view, frame) {
    const { gl } = this, d = this.drawn, place = this.points.attributes.position;
    const count = Math.floor(frame.mapCount / this.stride);
    if (count === 0) return;
    this.usePoints(view, 0.05, 1, d.heights || [-2, 4], [0, 0, 0, 0]);
    gl.depthFunc(gl.LEQUAL);
    gl.bindBuffer(gl.ARRAY_BUFFER, d.map.buffer);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribDivisor(place, 0);
    gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 12 * this.stride, 0);
    gl.drawArrays(gl.POINTS, 0, count);
    gl.disableVertexAttribArray(place);
  }

  drawScan(view, frame) {
    const { gl } = this, place = this.points.attributes.position;
    const r = rotationOf(frame.rotation), s = frame.scan, u = frame.scanResolution;
    const placed = new Float32Array(s.length);
    for (let n = 0; n < s.length; n += 3) {
      placed.set(add(frame.position, turned(r, [u * s[n], u * s[n + 1], u * s[n + 2]])), n);
    }
    this.usePoints(view, 0.12, 2, [0, 1], [...SCAN_COLOR[this.theme], 1]);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.scanBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, placed, gl.STREAM_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribDivisor(place, 0);
    gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
    gl.drawArrays(gl.POINTS, 0, s.length / 3);
    gl.disableVertexAttribArray(place);
  }

  useLines(view, width, byStatus) {
    const { gl } = this, { program, uniforms } = this.lines;
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.matrix, false, view.matrix);
    gl.uniform2f(uniforms.pixels, this.canvas.width, this.canvas.height);
    gl.uniform1f(uniforms.width, width * Math.min(window.devicePixelRatio || 1, 2));
    gl.uniform1f(uniforms.by_status, byStatus ? 1 : 0);
    gl.uniform4fv(uniforms.statuses, STATUS_COLORS[this.theme].flatMap((c) => [...rgb(c), 1]));
  }

  /** Attributes of instances: [name, floats, bytes from the start]. */
  drawInstances(count, stride, layout) {
    const { gl } = this, { attributes } = this.lines;
    for (const [name, size, offset] of layout) {
      gl.enableVertexAttribArray(attributes[name]);
      gl.vertexAttribPointer(attributes[name], size, gl.FLOAT, false, stride, offset);
      gl.vertexAttribDivisor(attributes[name], 1);
    }
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    for (const [name] of layout) gl.disableVertexAttribArray(attributes[name]);
  }

  drawTrack(view, frames) {
    const { gl } = this;
    if (frames < 2) return;
    gl.depthFunc(gl.ALWAYS); // the track is what one came for: no wall hides it
    this.useLines(view, 4, true);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.drawn.track.buffer);
    gl.vertexAttrib4f(this.lines.attributes.color, 0, 0, 0, 1);
    this.drawInstances(frames - 1, 16, [["from", 4, 0], ["to", 4, 16]]);
  }

  addLine(from, to, color, alpha) {
    if (FLOATS_OF_LINE * (this.lineCount + 1) > this.lineArray.length) {
      const larger = new Float32Array(2 * this.lineArray.length);
      larger.set(this.lineArray);
      this.lineArray = larger;
    }
    this.lineArray.set([...from, 0, ...to, 0, ...color, alpha], FLOATS_OF_LINE * this.lineCount++);
  }

  drawLines(view, width, depth) {
    const { gl } = this;
    if (this.lineCount === 0) return;
    gl.depthFunc(depth);
    this.useLines(view, width, false);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.lineBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, this.lineArray.subarray(0, FLOATS_OF_LINE * this.lineCount), gl.STREAM_DRAW);
    this.drawInstances(this.lineCount, 4 * FLOATS_OF_LINE, [["from", 4, 0], ["to", 4, 16], ["color", 4, 32]]);
  }

  /** On the ground, in steps of a round number of metres. */
  addGrid(camera, view, frame) {
    const step = gridStep(view.height);
    this.gridStep = step;
    const ground = this.drawn && this.drawn.ground !== undefined ? this.drawn.ground
      : (frame ? frame.position[2] - 1.8 : 0);
    const color = rgb(this.theme === "dark" ? "#2a313c" : "#d9dbd6");
    const centre = camera.target.map((v) => step * Math.round(v / step)), reach = 20 * step;
    for (let k = -20; k <= 20; ++k) {
      // Fading out with the distance instead of ending.
      const fade = 1 - Math.abs(k) / 21;
      const x = centre[0] + k * step, y = centre[1] + k * step;
      this.addLine([x, centre[1] - reach, ground], [x, centre[1] + reach, ground], color, fade);
      this.addLine([centre[0] - reach, y, ground], [centre[0] + reach, y, ground], color, fade);
    }
  }

  /** Axes of the frame, three sections of the 3-sigma ellipsoid, the weak directions. */
  addPose(frame, view) {
    const size = view.height / 22;
    const r = rotationOf(frame.rotation), p = frame.position;
    const ofChild = (v) => add(p, turned(r, v));
    AXIS_COLORS.forEach((color, k) => {
      const end = [0, 0, 0];
      end[k] = size;
      this.addLine(p, ofChild(end), color, 1);
    });
    const color = rgb(STATUS_COLORS[this.theme][frame.status]);
    if (frame.covariance) this.addEllipsoid(frame.covariance, ofChild, color);
    for (const weak of frame.weak) this.addWeak(weak, ofChild, 2.2 * size);
  }

  addEllipsoid(covariance, ofChild, color) {
    const rows = [0, 1, 2].map((k) => [0, 1, 2].map((m) => covariance[6 * k + m]));
    const { values, vectors } = symmetricEigen(rows);
    const axes = vectors.map((v, k) => scale(v, 3 * Math.sqrt(Math.max(values[k], 0))));
    const parts = 48;
    for (const [a, b] of [[0, 1], [0, 2], [1, 2]]) {
      const at = (k) => {
        const angle = (2 * Math.PI * k) / parts;
        return ofChild(add(scale(axes[a], Math.cos(angle)), scale(axes[b], Math.sin(angle))));
      };
      for (let k = 0; k < parts; ++k) this.addLine(at(k), at(k + 1), color, 0.8);
    }
  }

  /** A double arrow along it; of a rotation, an arc about its axis. The weaker the longer. */
  addWeak({ direction, fromScan }, ofChild, size) {
    const color = rgb(STATUS_COLORS[this.theme][2]);
    const moves = direction.slice(0, 3), turns = direction.slice(3);
    const reach = size * (1 - 0.7 * fromScan);
    if (Math.hypot(...moves) >= Math.hypot(...turns)) {
      const end = scale(moves, reach), aside = Math.abs(moves[2]) < 0.9 ? [-moves[1], moves[0], 0] : [1, 0, 0];
      for (const s of [1, -1]) {
        this.addLine(ofChild([0, 0, 0]), ofChild(scale(end, s)), color, 1);
        for (const t of [0.25, -0.25]) {
          const barb = add(scale(end, 0.75 * s), scale(aside, t * reach));
          this.addLine(ofChild(scale(end, s)), ofChild(barb), color, 1);
        }
      }
      return;
    }
    const k = [0, 1, 2].reduce((best, n) => (Math.abs(turns[n]) > Math.abs(turns[best]) ? n : best), 0);
    const at = (angle) => {
      const v = [0, 0, 0];
      v[(k + 1) % 3] = 0.6 * reach * Math.cos(angle);
      v[(k + 2) % 3] = 0.6 * reach * Math.sin(angle);
      return ofChild(v);
    };
    for (let n = -12; n < 12; ++n) this.addLine(at(n / 8), at((n + 1) / 8), color, 1);
  }
}

/** 1, 2 or 5 times a power of ten: about a tenth of the view. */
export function gridStep(height) {
  const power = 10 ** Math.floor(Math.log10(height / 8));
  const parts = height / 8 / power;
  return power * (parts < 2 ? 1 : parts < 5 ? 2 : 5);
}
