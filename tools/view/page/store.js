// SPDX-License-Identifier: BSD-3-Clause
// What has been received: poses in the order of their arrival, the map of each session.

import { rotationOf } from "./math.js";

export const MOST_POINTS = 1000000; // of a map
const MOST_FRAMES = 36000; // an hour at 10 Hz
const MOST_SESSIONS = 8;
const MOST_SCAN_NUMBERS = 16 * 1024 * 1024; // of 2 bytes each
const FINEST_VOXEL_M = 0.15;

/** Points of the odometry frame in the order of their arrival, one a voxel; at most MOST_POINTS. */
export class PointMap {
  constructor(most = MOST_POINTS) {
    this.most = most;
    this.voxel = FINEST_VOXEL_M; // m; grows when the map is full
    this.count = 0;
    this.positions = new Float32Array(3 * 16384);
    this.table = new Int32Array(1 << 16); // hash of voxels: index + 1 of their point, 0 is empty
    this.version = 0; // another one: points were left out, all is to be uploaded again
  }

  /** Place of the voxel's point in the table, or of the empty slot for it. */
  slot(x, y, z) {
    const mask = this.table.length - 1, p = this.positions, v = this.voxel;
    const i = Math.floor(x / v), j = Math.floor(y / v), k = Math.floor(z / v);
    let at = (Math.imul(i, 73856093) ^ Math.imul(j, 19349663) ^ Math.imul(k, 83492791));
    at = (at ^ (at >>> 15)) & mask;
    for (;; at = (at + 1) & mask) {
      const n = 3 * (this.table[at] - 1);
      if (n < 0) return at;
      if (Math.floor(p[n] / v) === i && Math.floor(p[n + 1] / v) === j &&
          Math.floor(p[n + 2] / v) === k) return at;
    }
  }

  /** True when it became part of the map. */
  add(x, y, z) {
    // As the array will have them, or a point at a border would not be found again.
    x = Math.fround(x); y = Math.fround(y); z = Math.fround(z);
    const at = this.slot(x, y, z);
    if (this.table[at] !== 0) return false;
    if (3 * this.count === this.positions.length) this.grow();
    this.positions.set([x, y, z], 3 * this.count);
    this.table[at] = ++this.count;
    if (2 * this.count > this.table.length) this.rehash(2 * this.table.length);
    return true;
  }

  grow() {
    const larger = new Float32Array(Math.min(2 * this.positions.length, 3 * (this.most + 1)));
    larger.set(this.positions);
    this.positions = larger;
  }

  rehash(size) {
    this.table = new Int32Array(size);
    const p = this.positions;
    for (let n = 0; n < this.count; ++n) {
      this.table[this.slot(p[3 * n], p[3 * n + 1], p[3 * n + 2])] = n + 1;
    }
  }

  get full() { return this.count >= this.most; }

  /**
   * Larger voxels, and one point in each: the first that came. Gives for every number of points
   * before how many of them are left.
   */
  thin() {
    this.voxel *= 1.5;
    const left = new Int32Array(this.count + 1);
    const before = this.positions, count = this.count;
    this.table.fill(0);
    this.positions = new Float32Array(before.length);
    this.count = 0;
    for (let n = 0; n < count; ++n) {
      const at = this.slot(before[3 * n], before[3 * n + 1], before[3 * n + 2]);
      if (this.table[at] === 0) {
        this.positions.set(before.subarray(3 * n, 3 * n + 3), 3 * this.count);
        this.table[at] = ++this.count;
      }
      left[n + 1] = this.count;
    }
    ++this.version;
    return left;
  }
}

/** All of one session: one origin. */
class Session {
  constructor(id, number) {
    this.id = id;
    this.number = number; // from 1
    this.map = new PointMap();
    this.first = 0; // of its frames in the store
    this.missed = 0;
  }
}

export class Store {
  constructor() {
    this.clear();
  }

  clear() {
    this.frames = []; // of all sessions
    this.sessions = [];
    this.health = null;
    this.healthAt = 0; // performance.now()
    this.poseAt = 0;
    this.scanNumbers = 0;
    this.version = (this.version || 0) + 1; // another one: frames were left out
  }

  get last() { return this.frames[this.frames.length - 1]; }

  addPose(pose) {
    const before = this.last;
    let session = this.sessions[this.sessions.length - 1];
    if (!session || session.id !== pose.session) {
      session = new Session(pose.session, session ? session.number + 1 : 1);
      session.first = this.frames.length;
      this.sessions.push(session);
      if (this.sessions.length > MOST_SESSIONS) this.forgetOldest();
    }
    const joins = before && before.session === session;
    const missed = joins ? Math.max(pose.seq - before.seq - 1, 0) : 0;
    if (joins && pose.seq <= before.seq) return; // came late, or twice
    session.missed += missed;
    this.frames.push({ ...pose, session, gap: missed > 0 || this.isLate(before, pose, joins),
      distance: joins ? before.distance + distance(before.position, pose.position) : 0,
      mapCount: session.map.count, scan: null, scanResolution: 0.01 });
    this.poseAt = performance.now();
    if (this.frames.length > MOST_FRAMES) this.thinFrames();
  }

  forgetOldest() {
    this.sessions.shift();
    const [{ first }] = this.sessions;
    for (const frame of this.frames.splice(0, first)) this.scanNumbers -= frame.scan ? frame.scan.length : 0;
    for (const session of this.sessions) session.first -= first;
    ++this.version;
  }

  /** Whether scans are missing between two poses that follow one another. */
  isLate(before, pose, joins) {
    if (!joins || this.frames.length - before.session.first < 3) return false;
    const usual = before.time - this.frames[this.frames.length - 2].time;
    return pose.time - before.time > Math.max(2.5 * usual, 0.25);
  }

  addPoints(points) {
    const frame = this.frameOf(points);
    if (!frame) return; // its pose was lost: nobody knows where they are
    const r = rotationOf(frame.rotation), [px, py, pz] = frame.position;
    const { map } = frame.session, s = points.steps, u = points.resolution;
    for (let n = 0; n < s.length; n += 3) {
      const x = u * s[n], y = u * s[n + 1], z = u * s[n + 2];
      map.add(px + r[0][0] * x + r[0][1] * y + r[0][2] * z,
        py + r[1][0] * x + r[1][1] * y + r[1][2] * z, pz + r[2][0] * x + r[2][1] * y + r[2][2] * z);
      if (map.full) this.thinMap(frame.session);
    }
    frame.mapCount = map.count;
    if (points.set === "scan") this.keepScan(frame, points);
  }

  frameOf({ session, seq }) {
    for (let k = this.frames.length - 1; k >= Math.max(0, this.frames.length - 20); --k) {
      const frame = this.frames[k];
      if (frame.seq === seq && frame.session.id === session) return frame;
    }
    return null;
  }

  keepScan(frame, points) {
    const before = frame.scan ? frame.scan.length : 0;
    const all = new Int16Array(before + points.steps.length);
    if (frame.scan) all.set(frame.scan);
    all.set(points.steps, before);
    frame.scan = all;
    frame.scanResolution = points.resolution;
    this.scanNumbers += points.steps.length;
    if (this.scanNumbers > MOST_SCAN_NUMBERS) this.thinScans();
  }

  thinMap(session) {
    const left = session.map.thin();
    for (const frame of this.frames) {
      if (frame.session === session) frame.mapCount = left[frame.mapCount];
    }
  }

  /** Of the older half, every second scan that is still there. */
  thinScans() {
    let n = 0;
    for (const frame of this.frames.slice(0, this.frames.length >> 1)) {
      if (!frame.scan || n++ % 2 === 0) continue;
      this.scanNumbers -= frame.scan.length;
      frame.scan = null;
    }
  }

  /** Every second frame of the older half goes; where one was missing before it, one still is. */
  thinFrames() {
    const kept = [], half = this.frames.length >> 1;
    this.frames.forEach((frame, k) => {
      const next = this.frames[k + 1];
      if (k >= half || k % 2 === 0 || next.session !== frame.session) {
        kept.push(frame);
      } else {
        next.gap = next.gap || frame.gap;
        if (frame.scan) this.scanNumbers -= frame.scan.length;
      }
    });
    this.frames = kept;
    for (const session of this.sessions) session.first = kept.findIndex((f) => f.session === session);
    this.sessions = this.sessions.filter((session) => session.first >= 0);
    ++this.version;
  }

  setHealth(health) {
    this.health = health;
    this.healthAt = performance.now();
  }
}

function distance(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
