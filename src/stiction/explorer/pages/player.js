// Time: it plays, stands, is moved by hand, and follows the sound where that is heard.

// Times as slow as the run: holds of an hour, and years on a fault, pass faster than they last.
export const SPEEDS = [1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.1, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000];

export function speedText(slow) {
  if (slow === 1) return "real time";
  const ratio = Math.round(slow < 1 ? 1 / slow : slow).toLocaleString("en");
  return slow < 1 ? `${ratio} : 1` : `1 : ${ratio}`;
}

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
