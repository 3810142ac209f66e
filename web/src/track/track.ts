// A track: everything that is shown, in order. Live it grows at its end; a replay is whole from the start.

import type { Asked, EventMessage, Hello, Message, Notice, Placed, Pose, Status } from "../protocol.ts";
import { blendPlaced, blendQuaternions, wrap } from "./blending.ts";

const JUMP_M = 0.8;
/** A body that is further away after one sample was put there, and did not walk. */
const PAUSE_S = 0.2;
/** Between samples further apart than this nothing moved, until just before the later one. */

/** How the room stands at one moment. */
export interface Moment {
  body: [number, number, number];
  pelvis: [number, number, number];
  joints: Float32Array;
  eyes: [number, number];
  held: number | null;
  things: Map<number, Placed>;
  gone: ReadonlySet<number>;
  /** How bright it is, where 1 is as at the start. */
  lights: number;
}

interface Stamped<T> {
  t: number;
  value: T;
}

/** Index of the last item at or before a time; -1 if there is none. */
export function lastBefore(items: readonly { t: number }[], t: number): number {
  let low = 0;
  let high = items.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((items[middle] as { t: number }).t <= t) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

export class Track {
  readonly poses: Pose[] = [];
  readonly events: EventMessage[] = [];
  readonly statuses: Status[] = [];
  readonly asked: Asked[] = [];
  readonly notices: Notice[] = [];
  private readonly things = new Map<number, Stamped<Placed>[]>();
  private readonly gone: Stamped<ReadonlySet<number>>[] = [];
  private readonly lights: Stamped<number>[] = [];
  /** All lights together, at the start. */
  private bright = 0;
  private latest = 0;
  /** Serial number of the last message. */
  last = 0;

  constructor(readonly hello: Hello) {}

  /** Time of the last message, seconds. */
  get end(): number {
    return this.latest;
  }

  get start(): number {
    return this.poses[0]?.t ?? 0;
  }

  /** Take the next message; those that are known are left out. Returns whether it was new. */
  add(message: Message): boolean {
    if (message.n <= this.last && message.n !== 0) return false;
    this.last = Math.max(this.last, message.n);
    this.latest = Math.max(this.latest, message.t);
    switch (message.type) {
      case "pose":
        this.addPose(message);
        break;
      case "event":
        this.events.push(message);
        break;
      case "status":
        this.statuses.push(message);
        break;
      case "asked":
        this.asked.push(message);
        break;
      case "notice":
        this.notices.push(message);
        break;
      case "hello":
        break;
    }
    return true;
  }

  private addPose(pose: Pose): void {
    this.poses.push(pose);
    for (const [key, value] of Object.entries(pose.things)) {
      const id = Number(key);
      const known = this.things.get(id);
      if (known) known.push({ t: pose.t, value });
      else this.things.set(id, [{ t: pose.t, value }]);
    }
    if (pose.gone) this.gone.push({ t: pose.t, value: new Set(pose.gone) });
    if (pose.lights) {
      const all = pose.lights.reduce((sum, light) => sum + light, 0);
      if (!this.lights.length) this.bright = all;
      this.lights.push({ t: pose.t, value: this.bright > 0 ? all / this.bright : 1 });
    }
  }

  /** How the room stood at a time; null before the first pose is known. */
  at(t: number): Moment | null {
    const first = this.poses[0];
    if (!first) return null;
    const index = Math.max(0, lastBefore(this.poses, t));
    const before = this.poses[index] as Pose;
    const after = this.poses[index + 1] ?? before;
    const share = shareBetween(before, after, t);
    return {
      body: blendBody(before, after, share),
      pelvis: blendThree(before.pelvis, after.pelvis, share),
      joints: blendQuaternions(before.joints, after.joints, share),
      eyes: blendTwo(before.eyes, after.eyes, share),
      held: share < 0.5 ? before.held : after.held,
      things: this.thingsBetween(before.t, after.t, share),
      gone: valueAt(this.gone, before.t) ?? NONE,
      lights: valueAt(this.lights, before.t) ?? 1,
    };
  }

  private thingsBetween(from: number, to: number, share: number): Map<number, Placed> {
    const placed = new Map<number, Placed>();
    for (const [id, stamps] of this.things) {
      const index = lastBefore(stamps, from);
      const before = stamps[Math.max(index, 0)] as Stamped<Placed>;
      const after = stamps[index + 1];
      const moves = after !== undefined && index >= 0 && after.t <= to && share > 0;
      placed.set(id, moves ? blendPlaced(before.value, after.value, share) : before.value);
    }
    return placed;
  }

  statusAt(t: number): Status | null {
    return this.statuses[lastBefore(this.statuses, t)] ?? null;
  }
}

const NONE: ReadonlySet<number> = new Set();

function valueAt<T>(stamps: readonly Stamped<T>[], t: number): T | undefined {
  return stamps[lastBefore(stamps, t)]?.value;
}

function shareBetween(before: Pose, after: Pose, t: number): number {
  const long = after.t - before.t;
  if (long <= 0 || t <= before.t) return 0;
  const far = Math.hypot(after.body[0] - before.body[0], after.body[1] - before.body[1]);
  if (far > JUMP_M) return t >= after.t ? 1 : 0;
  const moving = Math.min(long, PAUSE_S);
  return Math.min(1, Math.max(0, (t - (after.t - moving)) / moving));
}

function blendTwo(a: readonly [number, number], b: readonly [number, number], share: number): [number, number] {
  return [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];
}

function blendThree(
  a: readonly [number, number, number],
  b: readonly [number, number, number],
  share: number,
): [number, number, number] {
  return [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, a[2] + (b[2] - a[2]) * share];
}

function blendBody(before: Pose, after: Pose, share: number): [number, number, number] {
  const [x, y] = blendThree(before.body, after.body, share);
  return [x, y, before.body[2] + wrap(after.body[2] - before.body[2]) * share];
}
