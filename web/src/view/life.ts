// Her bearing over every motion: she turns to whom she talks to, tilts her head when she listens, looks
// aside when she thinks, glances, and breathes.

import { Quaternion, Vector3 } from "three";
import type { Doing } from "../protocol.ts";

export type Bearing = "busy" | "idle" | "listening" | "thinking";

/** How she bears herself while she is at something. */
export const BEARINGS: Readonly<Record<Doing, Bearing>> = {
  idle: "idle",
  seeing: "busy",
  thinking: "thinking",
  acting: "busy",
  asking: "listening",
  waiting_for_you: "listening",
  closed: "idle",
};

interface Turn {
  yaw: number;
  pitch: number;
  roll: number;
}

/** Nine tenths of a new bearing are there after 0.15 seconds. */
const EASE = 15;
const MOST_YAW = 0.85;
const MOST_PITCH = 0.42;
const NECK = 0.4;
const BREATH_S = 4;
const BREATH = 0.018;
const GLANCE = 0.022;
const NEXT_GLANCE_S: readonly [number, number] = [0.5, 2.2];
/** What is less is not seen, and not drawn anew. */
const LEAST = 0.0008;
/** How far the head goes to whoever looks on. */
const TOWARDS: Readonly<Record<Bearing, number>> = { busy: 0, idle: 0.8, listening: 1, thinking: 0.25 };

/** Where the head should turn to, from where the motion has it; radians: left, down, to the right. */
export function wished(bearing: Bearing, viewer: Vector3): Turn {
  const flat = Math.hypot(viewer.x, viewer.y);
  const yaw = Math.atan2(viewer.y, viewer.x);
  // Behind her she does not look round for anybody.
  const share = TOWARDS[bearing] * Math.min(1, Math.max(0, (2.2 - Math.abs(yaw)) / 0.6));
  const turn = {
    yaw: share * Math.min(MOST_YAW, Math.max(-MOST_YAW, yaw)),
    pitch: share * Math.min(MOST_PITCH, Math.max(-MOST_PITCH, -Math.atan2(viewer.z, flat))),
    roll: 0,
  };
  if (bearing === "listening") turn.roll = 0.09;
  if (bearing === "thinking") {
    turn.yaw += 0.24;
    turn.pitch -= 0.14;
    turn.roll = -0.05;
  }
  return turn;
}

const axes = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };
const part = new Quaternion();

function turned(into: Quaternion, { yaw, pitch, roll }: Turn, share: number): Quaternion {
  into.setFromAxisAngle(axes.z, yaw * share);
  into.multiply(part.setFromAxisAngle(axes.y, pitch * share));
  return into.multiply(part.setFromAxisAngle(axes.x, roll * share));
}

export class Life {
  /** On top of the motion's own turns of these joints. */
  readonly neck = new Quaternion();
  readonly head = new Quaternion();
  readonly chest = new Quaternion();
  private readonly now: Turn = { yaw: 0, pitch: 0, roll: 0 };
  private readonly glance = { yaw: 0, pitch: 0 };
  private glanceAt = 0;
  private time = 0;

  /**
   * @param breathes Whether she breathes and glances: a processor that draws would never rest.
   * @param random For where she glances, and when.
   */
  constructor(
    private readonly breathes: () => boolean,
    private readonly random: () => number = Math.random,
  ) {}

  /**
   * Go on; returns whether anything moved.
   * @param viewer From her head, as the motion turns it: X ahead, Y left, Z up.
   */
  update(seconds: number, bearing: Bearing, viewer: Vector3): boolean {
    this.time += seconds;
    const wish = wished(bearing, viewer);
    const lives = this.breathes();
    if (lives && bearing !== "busy") this.look();
    else this.glance.yaw = this.glance.pitch = 0;
    wish.yaw += this.glance.yaw;
    wish.pitch += this.glance.pitch;
    const share = 1 - Math.exp(-EASE * seconds);
    let moved = lives;
    for (const key of ["yaw", "pitch", "roll"] as const) {
      const left = wish[key] - this.now[key];
      if (Math.abs(left) < LEAST) continue;
      this.now[key] += left * share;
      moved = true;
    }
    turned(this.neck, this.now, NECK);
    turned(this.head, this.now, 1 - NECK);
    const full = lives ? 0.5 - 0.5 * Math.cos((2 * Math.PI * this.time) / BREATH_S) : 0;
    this.chest.setFromAxisAngle(axes.y, -BREATH * full);
    return moved;
  }

  private look(): void {
    if (this.time < this.glanceAt) return;
    const [least, most] = NEXT_GLANCE_S;
    this.glanceAt = this.time + least + (most - least) * this.random();
    this.glance.yaw = GLANCE * (2 * this.random() - 1);
    this.glance.pitch = 0.6 * GLANCE * (2 * this.random() - 1);
  }
}
