// Time: it plays, stands, is moved by hand, and follows the sound where that is heard.

export const SPEEDS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000];

export class Player {
  constructor(changed) {
    Object.assign(this, { t: 0, playing: false, slow: 10, start: 0, end: 1, changed, frames: [] });
  }

  span(start, end) {
    Object.assign(this, { start, end });
    this.t = Math.min(Math.max(this.t, start), end);
  }

  seek(t) {
    this.t = Math.min(Math.max(t, this.start), this.end);
    this.changed("seek");
  }

  toggle(playing = !this.playing) {
    if (playing && this.t >= this.end) this.t = this.start;
    this.playing = playing;
    this.last = undefined;
    this.changed("play");
  }

  // One frame of the screen; `now` in ms; `heard` is the time of the sound, if one is heard.
  frame(now, heard) {
    this.frames.push(now);
    while (this.frames[0] < now - 1000) this.frames.shift();
    if (!this.playing) return;
    if (heard !== null) this.t = heard;
    else if (this.last !== undefined) this.t += (Math.min(now - this.last, 250) * 1e-3) / this.slow;
    this.last = now;
    if (this.t >= this.end) {
      this.t = this.start;
      this.changed("again");
    }
  }
}
