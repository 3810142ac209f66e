// Fits the quality to the machine: sharper pictures and shadows where frames come fast, plainer ones where not.

export interface Level {
  /** Share of the screen's own pixels. */
  pixels: number;
  shadow: number;
}

export const LEVELS: readonly Level[] = [
  { pixels: 0.5, shadow: 1024 },
  { pixels: 0.62, shadow: 1024 },
  { pixels: 0.75, shadow: 1024 },
  { pixels: 0.87, shadow: 1536 },
  { pixels: 1, shadow: 2048 },
];

/** A movement that is slower than this gets coarser pictures, and one that is faster sharper ones; milliseconds a picture. */
const PACE = { card: { slow: 80, fast: 24 }, processor: { slow: 115, fast: 70 } } as const;
/** Fewer pixels than this save no time: corners of triangles take more. */
const LEAST = 240_000;
/** So many frames are looked at before the level changes again. */
const CALM = 8;

export class Quality {
  level: number;
  /** Mean time between two pictures of a movement, milliseconds. */
  frameMs = 0;
  private count = 0;
  private ceiling: number;
  private readonly pace: { slow: number; fast: number };

  /** Where a processor draws, it begins coarser, and movements may be slower for the sake of their sharpness. */
  constructor(isPlain = false) {
    this.level = isPlain ? 2 : LEVELS.length - 1;
    this.ceiling = LEVELS.length - 1;
    this.pace = isPlain ? PACE.processor : PACE.card;
  }

  /** Take note of the time since the last picture. Returns whether the level changed. */
  note(ms: number): boolean {
    if (ms > 1000) return false;
    this.frameMs = this.frameMs === 0 ? ms : this.frameMs * 0.8 + ms * 0.2;
    if (++this.count < CALM) return false;
    if (this.frameMs > this.pace.slow && this.level > 0) return this.go(this.level - 1, true);
    if (this.frameMs < this.pace.fast && this.level < this.ceiling) return this.go(this.level + 1, false);
    return false;
  }

  private go(level: number, isWorse: boolean): boolean {
    // What proved too slow is not tried again, or it would swing to and fro.
    if (isWorse) this.ceiling = level;
    this.level = level;
    this.count = 0;
    this.frameMs = 0;
    return true;
  }

  /**
   * Share of the screen's own pixels that pictures of a movement have.
   * @param all How many pixels those are.
   */
  share(all: number): number {
    return Math.min(1, Math.max(this.current.pixels, Math.sqrt(LEAST / all)));
  }

  get current(): Level {
    return LEVELS[this.level] as Level;
  }
}
