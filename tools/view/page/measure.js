// SPDX-License-Identifier: BSD-3-Clause
// Distances between points of the map that were clicked.

import { project, sub } from "./math.js";

const NEAR_PX = 14;

export class Measure {
  constructor() {
    this.active = false;
    this.points = [];
  }

  toggle() {
    this.active = !this.active;
    this.points = [];
  }

  /** The map point nearest to the eye among those near the pointer (x, y: parts of the view). */
  pick(map, count, view, x, y, width, height) {
    const { positions } = map;
    let best = null, bestScore = Infinity;
    for (let n = 0; n < 3 * count; n += 3) {
      const [px, py, w] = project(view.matrix, [positions[n], positions[n + 1], positions[n + 2]]);
      if (w <= 0) continue;
      const off = Math.hypot(((px - x) * width) / 2, ((py - y) * height) / 2);
      if (off > NEAR_PX) continue;
      const score = off + (view.isFlat ? 0 : w);
      if (score < bestScore) {
        bestScore = score;
        best = [positions[n], positions[n + 1], positions[n + 2]];
      }
    }
    if (!best) return false;
    if (this.points.length >= 2) this.points = [];
    this.points.push(best);
    return true;
  }

  /** "12.34 m, 1.20 m up"; empty while there are no two points. */
  get text() {
    if (this.points.length < 2) return this.active ? "click two points" : "";
    const [dx, dy, dz] = sub(this.points[1], this.points[0]);
    return `${Math.hypot(dx, dy, dz).toFixed(2)} m: ${Math.hypot(dx, dy).toFixed(2)} m along, ` +
      `${Math.abs(dz).toFixed(2)} m ${dz < 0 ? "down" : "up"}`;
  }
}
