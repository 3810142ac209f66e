// The clock of a track: replays it, or stays close behind the end of one that grows.

import type { Track } from "./track.ts";

export const SPEEDS = [0.5, 1, 2, 4] as const;
const BEHIND_S = 0.12;
/** So far behind the end the page stays, so that samples that come late are not missed. */
const LOST_S = 1.5;
/** Further behind than this, it jumps. */

export class Player {
  /** Seconds of the room's simulated time. */
  time = 0;
  playing = true;
  speed = 1;
  /** Whether it follows the end of a live track. */
  following: boolean;
  private readonly listeners: (() => void)[] = [];

  constructor(readonly track: Track) {
    this.following = track.hello.live;
    this.time = this.following ? track.end : track.start;
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  private changed(): void {
    for (const listener of this.listeners) listener();
  }

  /** Go on by some seconds of real time. Returns whether time moved. */
  advance(seconds: number): boolean {
    const before = this.time;
    if (this.following) this.follow(seconds);
    else if (this.playing) {
      this.time = Math.min(this.track.end, this.time + seconds * this.speed);
      if (this.time >= this.track.end) {
        if (this.track.hello.live) this.following = true;
        else this.playing = false;
        this.changed();
      }
    }
    return this.time !== before;
  }

  private follow(seconds: number): void {
    const pace = this.track.statuses.at(-1)?.speed ?? 1;
    const behind = this.track.end - this.time;
    if (behind > LOST_S * pace || behind < 0) {
      this.time = Math.max(this.track.start, this.track.end - BEHIND_S);
      return;
    }
    const drift = 1 + Math.max(-0.5, Math.min(1, (behind - BEHIND_S * pace) * 2));
    this.time = Math.min(this.track.end, this.time + seconds * pace * drift);
  }

  seek(time: number): void {
    const end = this.track.end;
    this.time = Math.min(end, Math.max(this.track.start, time));
    this.following = this.track.hello.live && this.time >= end - 0.01;
    if (!this.following && this.track.hello.live) this.playing = false;
    this.changed();
  }

  /** Play or pause; at the end of a replay, start again. */
  toggle(): void {
    if (this.following) {
      this.following = false;
      this.playing = false;
    } else if (!this.playing && this.time >= this.track.end - 0.001 && !this.track.hello.live) {
      this.time = this.track.start;
      this.playing = true;
    } else this.playing = !this.playing;
    this.changed();
  }

  /** Follow the end of a live track again. */
  catchUp(): void {
    this.following = this.track.hello.live;
    this.changed();
  }

  setSpeed(speed: number): void {
    this.speed = speed;
    this.changed();
  }

  /** Go to the next or the last event of the record. */
  step(direction: 1 | -1): void {
    const times = this.track.events.map((event) => event.t);
    const next =
      direction > 0
        ? times.find((t) => t > this.time + 0.001)
        : times.findLast((t) => t < this.time - 0.001);
    this.playing = false;
    this.seek(next ?? (direction > 0 ? this.track.end : this.track.start));
  }
}
