// SPDX-License-Identifier: BSD-3-Clause
// Where the scene is looked at from.

import { add, clamp, lookAt, multiply, orthographic, perspective, scale, sub, wrapped } from "./math.js";

const FOV = 0.9; // radians, upright
const FOLLOW_PITCH = 0.5;

export const MODES = ["follow", "free", "top"];

/**
 * Turns about a target. `follow` goes behind the sensor, `top` looks straight down with x up and
 * goes with it, `free` stays where it is. All changes are approached, so that nothing jumps.
 */
export class Camera {
  constructor() {
    this.mode = "follow";
    this.target = [0, 0, 0];
    this.yaw = 0; // direction it looks in, about z
    this.pitch = FOLLOW_PITCH; // down
    this.distance = 35; // m
    this.wanted = { distance: 35, pitch: FOLLOW_PITCH };
    this.turn = 0; // of the user's, from behind the sensor
    this.offset = [0, 0, 0]; // of the user's, from the sensor
    this.placed = false;
  }

  setMode(mode) {
    this.mode = mode;
    this.turn = 0;
    this.offset = [0, 0, 0];
    if (mode === "top") this.wanted.pitch = Math.PI / 2;
    else if (mode === "follow") this.wanted.pitch = FOLLOW_PITCH;
    else this.wanted.pitch = Math.min(this.pitch, 1.2);
  }

  /** A part of the way to where it should be; true while it is still on its way. */
  approach(position, heading, dt) {
    const s = 1 - Math.exp(-Math.min(dt, 0.5) * 6);
    const goals = { pitch: this.wanted.pitch, distance: this.wanted.distance };
    let moving = false;
    const step = (from, to, tolerance) => {
      if (Math.abs(to - from) < tolerance) return to;
      moving = true;
      return from + s * (to - from);
    };
    this.pitch = step(this.pitch, goals.pitch, 1e-3);
    this.distance = step(this.distance, goals.distance, 1e-3 * this.distance);
    if (this.mode === "free" || !position) return moving;
    const target = add(position, this.offset);
    // A new session begins elsewhere: gliding there would only show the void between.
    const far = Math.hypot(...sub(target, this.target)) > 4 * this.distance;
    if (!this.placed || far) this.target = target;
    this.placed = true;
    this.target = this.target.map((v, k) => step(v, target[k], 1e-3));
    const yaw = this.mode === "follow" ? heading + this.turn : this.turn;
    this.yaw = wrapped(step(this.yaw, this.yaw + wrapped(yaw - this.yaw), 1e-3));
    return moving;
  }

  orbit(right, up) {
    if (this.mode === "free") this.yaw = wrapped(this.yaw - right);
    else this.turn = wrapped(this.turn - right);
    if (this.mode !== "top") this.wanted.pitch = this.pitch = clamp(this.pitch + up, -0.2, 1.55);
  }

  /** By parts of the view's height. */
  pan(right, up) {
    const size = 2 * this.distance * Math.tan(FOV / 2);
    const ahead = [Math.cos(this.yaw), Math.sin(this.yaw), 0];
    const by = add(scale([ahead[1], -ahead[0], 0], -right * size), scale(ahead, -up * size));
    this.target = add(this.target, by);
    this.offset = add(this.offset, by);
  }

  zoom(factor) {
    this.wanted.distance = clamp(this.wanted.distance * factor, 2, 3000);
  }

  /** So that a box (its centre and half of its diagonal) is in view. */
  fit(centre, radius) {
    this.setMode("free");
    this.target = centre;
    this.wanted.pitch = 1.1;
    this.wanted.distance = clamp((1.15 * radius) / Math.tan(FOV / 2), 5, 3000);
  }

  /** The eye, the matrix to clip coordinates, and metres per part of the view's height at the target. */
  view(aspect) {
    const flat = Math.cos(this.pitch);
    const ahead = [Math.cos(this.yaw), Math.sin(this.yaw), 0];
    const direction = [flat * ahead[0], flat * ahead[1], -Math.sin(this.pitch)];
    const eye = sub(this.target, scale(direction, this.distance));
    const up = this.pitch > 1.5 ? ahead : [0, 0, 1];
    const far = 4000 + 2 * this.distance;
    const isFlat = this.mode === "top" && this.pitch > 1.5;
    const halfHeight = this.distance * Math.tan(FOV / 2);
    const projection = isFlat ? orthographic(halfHeight, aspect, -far, far)
      : perspective(FOV, aspect, Math.max(0.1, this.distance / 200), far);
    return { eye, matrix: multiply(projection, lookAt(eye, this.target, up)), height: 2 * halfHeight,
      isFlat };
  }
}
