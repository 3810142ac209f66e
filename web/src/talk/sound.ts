// Sound between microphone, server and loudspeaker: when somebody speaks, and WAV files.

export const RATE = 16_000;
/** A pause of this length ends what is said. */
export const PAUSE_MS = 500;
/** After this it may be one. */
export const EARLY_MS = 240;
const LEAST_LOUD = 0.012;
const ABOVE_NOISE = 3;
const SPEECH_MS = 90;
const FLOOR_FOLLOWS = 0.05;

export type Heard = "quiet" | "began" | "speaking" | "pausing" | "ended";

/** Tells from the loudness of a room when somebody begins and ends to speak. */
export class Ear {
  private floor = 0.004;
  private loudFor = 0;
  private quietFor = 0;
  private speaks = false;

  /** Take note of the loudness (root mean square, 0 to 1) of the last milliseconds. */
  note(loudness: number, ms: number): Heard {
    const isLoud = loudness > Math.max(LEAST_LOUD, ABOVE_NOISE * this.floor);
    if (!isLoud) this.floor += (loudness - this.floor) * FLOOR_FOLLOWS;
    this.loudFor = isLoud ? this.loudFor + ms : 0;
    this.quietFor = isLoud ? 0 : this.quietFor + ms;
    if (!this.speaks && this.loudFor >= SPEECH_MS) {
      this.speaks = true;
      return "began";
    }
    if (this.speaks && this.quietFor >= PAUSE_MS) {
      this.speaks = false;
      return "ended";
    }
    if (!this.speaks) return "quiet";
    return this.quietFor >= EARLY_MS ? "pausing" : "speaking";
  }
}

export function loudness(samples: Float32Array): number {
  let sum = 0;
  for (const value of samples) sum += value * value;
  return Math.sqrt(sum / Math.max(1, samples.length));
}

/** One channel of samples from -1 to 1 as a WAV file, 16 bits. */
export function wav(samples: Float32Array, rate: number): Blob {
  const view = new DataView(new ArrayBuffer(44 + samples.length * 2));
  const letters = (at: number, text: string): void => {
    for (let i = 0; i < text.length; i++) view.setUint8(at + i, text.charCodeAt(i));
  };
  letters(0, "RIFF");
  view.setUint32(4, 36 + samples.length * 2, true);
  letters(8, "WAVEfmt ");
  view.setUint32(16, 16, true);
  view.setUint16(20, 1, true);
  view.setUint16(22, 1, true);
  view.setUint32(24, rate, true);
  view.setUint32(28, rate * 2, true);
  view.setUint16(32, 2, true);
  view.setUint16(34, 16, true);
  letters(36, "data");
  view.setUint32(40, samples.length * 2, true);
  samples.forEach((value, i) => view.setInt16(44 + i * 2, Math.max(-1, Math.min(1, value)) * 32767, true));
  return new Blob([view.buffer], { type: "audio/wav" });
}
