// SPDX-License-Identifier: BSD-3-Clause
// Which frame is shown: the newest, or one of the past.

export class Player {
  constructor(store) {
    this.store = store;
    this.at = -1; // index in the store; -1: nothing yet
    this.live = true; // shows the newest
    this.playing = false;
    this.speed = 1;
    this.time = 0; // s, of what is shown
    this.storeVersion = store.version;
    this.frame = null; // what is shown
  }

  /** Time shown goes on with frames; between two of them that are far apart it jumps. */
  advance(dt) {
    const { frames } = this.store;
    const last = frames.length - 1;
    if (this.storeVersion !== this.store.version) this.find();
    this.storeVersion = this.store.version;
    if (last < 0) {
      this.at = -1;
    } else if (this.live || this.at < 0) {
      this.show(last);
    } else if (this.playing) {
      this.time += dt * this.speed;
      const longest = 1; // s: nobody waits through a break of the recording
      let at = this.at;
      while (at < last && this.passes(frames[at], frames[at + 1], longest)) ++at;
      this.at = at;
      if (at === last && !this.more) this.playing = false;
    }
    this.frame = frames[this.at];
    return this.at;
  }

  passes(from, to, longest) {
    const step = to.time - from.time;
    if (step < 0 || step > longest || to.session !== from.session) {
      this.time = to.time;
      return true;
    }
    return to.time <= this.time;
  }

  show(at) {
    this.at = Math.min(Math.max(at, 0), this.store.frames.length - 1);
    this.time = this.at >= 0 ? this.store.frames[this.at].time : 0;
  }

  /** Frames were left out: what was shown, or else the next one of its session, or the first. */
  find() {
    const { frames } = this.store, { frame } = this;
    const same = frames.indexOf(frame);
    const next = frames.findIndex((f) => frame && f.session === frame.session && f.time >= frame.time);
    this.show(same >= 0 ? same : Math.max(next, 0));
  }

  seek(at) {
    this.live = false;
    this.show(at);
  }

  toggle() {
    if (this.live) {
      this.live = false;
      this.playing = false;
      return;
    }
    if (!this.playing && this.at === this.store.frames.length - 1 && !this.more) this.show(0);
    this.playing = !this.playing;
  }

  goLive() {
    this.live = true;
    this.playing = false;
  }
}

/** The colours of all frames, and where sessions begin, along the slider. */
export function drawStrip(canvas, store, colors, line) {
  const width = Math.max(1, canvas.clientWidth), { frames } = store;
  canvas.width = width;
  canvas.height = 8;
  const context = canvas.getContext("2d");
  if (frames.length < 2) return;
  for (let x = 0; x < width; ++x) {
    const from = Math.floor((x * frames.length) / width);
    const to = Math.max(from + 1, Math.floor(((x + 1) * frames.length) / width));
    // The worst of those that share a pixel: a loss of one scan is seen in an hour.
    let worst = 1, begins = false;
    for (let k = from; k < to && k < frames.length; ++k) {
      const rank = [1, 0, 2, 3][frames[k].status];
      if (rank > [1, 0, 2, 3][worst]) worst = frames[k].status;
      begins = begins || (k > 0 && frames[k].session !== frames[k - 1].session);
    }
    context.fillStyle = begins ? line : colors[worst];
    context.fillRect(x, 0, 1, 8);
  }
}
