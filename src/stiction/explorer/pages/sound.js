// The transverse rate as sound, from the present time on, as slowly as the animation.

import { speedText } from "./player.js";
import { quantity } from "./quantity.js";

export class Sound {
  constructor() {
    this.on = false;
    this.position = null;
  }

  // Take the samples of a run: rate (Hz) and speed of the sound, start (s), values.
  load({ rate, start, speed, arrays }) {
    this.context ??= new AudioContext();
    const values = arrays.sound;
    let loudest = 0;
    for (const value of values) loudest = Math.max(loudest, Math.abs(value));
    this.buffer = this.context.createBuffer(1, Math.max(values.length, 1), rate);
    const channel = this.buffer.getChannelData(0);
    for (let i = 0; i < values.length; i++) channel[i] = loudest > 0 ? (0.8 * values[i]) / loudest : 0;
    Object.assign(this, { start, speed, end: start + this.buffer.duration * speed });
    this.stop();
  }

  play(t, slow) {
    this.stop();
    if (!this.on || !this.buffer || this.silent(t, slow)) return;
    this.context.resume();
    this.source = this.context.createBufferSource();
    this.source.buffer = this.buffer;
    this.source.playbackRate.value = 1 / (slow * this.speed);
    this.source.connect(this.context.destination);
    this.source.start(0, (t - this.start) / this.speed);
    Object.assign(this, { from: t, slow, began: this.context.currentTime });
  }

  // Why nothing can be heard at a time and a slowness; played faster than taken, it would be folded.
  silent(t, slow) {
    if (slow * this.speed < 1 - 1e-9) return `too high to be heard at ${speedText(slow)}: choose ${speedText(1 / this.speed)} or slower`;
    if (t < this.start || t >= this.end) return `the sound is that of ${quantity(this.start, "s")} to ${quantity(this.end, "s")}`;
    return "";
  }

  stop() {
    this.source?.stop();
    this.source = undefined;
  }

  // The time in the run that is heard now; null if nothing is.
  now() {
    if (!this.source || this.context.state !== "running") return null;
    const t = this.from + (this.context.currentTime - this.began) / this.slow;
    return t < this.end ? t : null;
  }
}
