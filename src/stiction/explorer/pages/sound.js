// The transverse rate as sound, from the present time on, as slowly as the animation.

export class Sound {
  constructor() {
    this.on = false;
    this.position = null;
  }

  // Take the samples of a run: rate (Hz), start (s), values.
  load({ rate, start, arrays }) {
    this.context ??= new AudioContext();
    const values = arrays.sound;
    let loudest = 0;
    for (const value of values) loudest = Math.max(loudest, Math.abs(value));
    this.buffer = this.context.createBuffer(1, Math.max(values.length, 1), rate);
    const channel = this.buffer.getChannelData(0);
    for (let i = 0; i < values.length; i++) channel[i] = loudest > 0 ? (0.8 * values[i]) / loudest : 0;
    this.start = start;
    this.stop();
  }

  play(t, slow) {
    this.stop();
    if (!this.on || !this.buffer || slow < 1 || t < this.start || t >= this.start + this.buffer.duration) return;
    this.context.resume();
    this.source = this.context.createBufferSource();
    this.source.buffer = this.buffer;
    this.source.playbackRate.value = 1 / slow;
    this.source.connect(this.context.destination);
    this.source.start(0, t - this.start);
    Object.assign(this, { from: t, slow, began: this.context.currentTime });
  }

  stop() {
    this.source?.stop();
    this.source = undefined;
  }

  // The time in the run that is heard now; null if nothing is.
  now() {
    if (!this.source || this.context.state !== "running") return null;
    const t = this.from + (this.context.currentTime - this.began) / this.slow;
    return t < this.start + this.buffer.duration ? t : null;
  }
}
