// SPDX-License-Identifier: BSD-3-Clause
// The stream: datagrams of daemon/PROTOCOL.md, a line each, and lines {"view":...} of lilo view itself.

/** Statuses as the protocol names them; their places are what the track is coloured by. */
export const STATUSES = ["initializing", "tracking", "degraded", "lost"];

const DIGITS = new Int16Array(128).fill(-1);
[..."ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"].forEach(
  (digit, value) => { DIGITS[digit.charCodeAt(0)] = value; });

/** x, y, z of every point one after the other, in steps: eight digits hold three 16-bit numbers. */
export function pointsFromBase64(text) {
  const out = new Int16Array(3 * Math.floor(text.length / 8));
  for (let at = 0, n = 0; n < out.length; at += 8, n += 3) {
    const d = (k) => DIGITS[text.charCodeAt(at + k) & 127];
    const b0 = (d(0) << 2) | (d(1) >> 4), b1 = ((d(1) & 15) << 4) | (d(2) >> 2);
    const b2 = ((d(2) & 3) << 6) | d(3), b3 = (d(4) << 2) | (d(5) >> 4);
    const b4 = ((d(5) & 15) << 4) | (d(6) >> 2), b5 = ((d(6) & 3) << 6) | d(7);
    out[n] = b0 | (b1 << 8);
    out[n + 1] = b2 | (b3 << 8);
    out[n + 2] = b4 | (b5 << 8);
  }
  return out;
}

const xyz = (v) => [v.x, v.y, v.z];

/** What the store keeps of a pose datagram. */
function poseOf(message) {
  const { pose } = message;
  return {
    session: message.session,
    seq: message.seq,
    time: pose.stamp.sec + pose.stamp.nsec * 1e-9,
    status: Math.max(STATUSES.indexOf(pose.status), 0),
    position: xyz(pose.position),
    rotation: [pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w],
    speed: pose.twist ? Math.hypot(...xyz(pose.twist.linear)) : null,
    covariance: pose.covariance ? Float32Array.from(pose.covariance) : null,
    weak: (pose.weak_directions || []).map((w) => ({ direction: w.direction, fromScan: w.from_scan })),
    latency: pose.latency_ms,
    lost: pose.lost_packets,
    frames: [pose.frame_id, pose.child_frame_id],
  };
}

function pointsOf({ session, seq, points }) {
  return { session, seq, set: points.of, resolution: points.resolution_m,
    steps: pointsFromBase64(points.xyz) };
}

/**
 * Calls handlers.pose, .points, .health, .view with what a message of lines holds. Kinds that it
 * does not know are passed over, as the protocol asks; so is a line that is no JSON.
 */
export function readLines(text, handlers) {
  for (const line of text.split("\n")) {
    if (line === "") continue;
    try {
      const message = JSON.parse(line);
      if (message.pose) handlers.pose(poseOf(message));
      else if (message.points) handlers.points(pointsOf(message));
      else if (message.health) handlers.health(message.health, message);
      else if (message.view) handlers.view(message.view);
      else if (message.done) handlers.answer(message.done.file || message.done.request);
      else if (message.error) handlers.answer(message.error.reason);
    } catch (error) {
      console.warn("a line that is not understood:", error.message);
    }
  }
}
