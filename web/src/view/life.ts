// Her bearing over every motion: she turns to whom she talks to, tilts her head when she listens, looks
// aside when she thinks, and breathes. Her eyes are there at once, before the head, and never rest; while
// she does something they are where the motion has them.

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

/** How the eyes are turned; radians: left, down. */
export interface Look {
  yaw: number;
  pitch: number;
}

interface Turn extends Look {
  roll: number;
}

/** Nine tenths of a new bearing are there after 0.15 seconds. */
const EASE = 15;
const MOST_YAW = 0.85;
const MOST_PITCH = 0.42;
const NECK = 0.4;
const BREATH_S = 4;
const BREATH = 0.018;
/** How far the eyes go from what they look at, and how long they stay. */
const GLANCE = 0.05;
const NEXT_GLANCE_S: readonly [number, number] = [0.4, 2];
/** Eyes turn no farther; the head does the rest. */
const MOST_EYES = 0.4;
/** A step of the eyes takes a twentieth of a second. */
const EYES_EASE = 60;
/** What is less is not seen, and not drawn anew. */
const LEAST = 0.0008;
/** How far the head goes to whoever looks on. */
const TOWARDS: Readonly<Record<Bearing, number>> = { busy: 0, idle: 0.8, listening: 1, thinking: 0.25 };

const within = (most: number, value: number): number => Math.min(most, Math.max(-most, value));

/** Which way whoever looks on is, and how much he counts: behind her she does not look round for anybody. */
function towards(viewer: Vector3): Look & { share: number } {
  const yaw = Math.atan2(viewer.y, viewer.x);
  const pitch = -Math.atan2(viewer.z, Math.hypot(viewer.x, viewer.y));
  return { yaw, pitch, share: Math.min(1, Math.max(0, (2.2 - Math.abs(yaw)) / 0.6)) };
}

/** Where the head should turn to, from where the motion has it; radians: left, down, to the right. */
export function wished(bearing: Bearing, viewer: Vector3): Turn {
  const { yaw, pitch, share } = towards(viewer);
  const much = share * TOWARDS[bearing];
  const turn = { yaw: much * within(MOST_YAW, yaw), pitch: much * within(MOST_PITCH, pitch), roll: 0 };
  if (bearing === "listening") turn.roll = 0.09;
  if (bearing === "thinking") {
    turn.yaw += 0.24;
    turn.pitch -= 0.14;
    turn.roll = -0.05;
  }
  return turn;
}

/** Where the eyes look, from where the motion has the head. */
export function lookedAt(bearing: Bearing, viewer: Vector3, motion: Look, head = wished(bearing, viewer)): Look {
  if (bearing === "busy") return motion;
  if (bearing === "thinking") return { yaw: head.yaw + 0.16, pitch: head.pitch - 0.1 };
  const { yaw, pitch, share } = towards(viewer);
  const own = 1 - share;
  return { yaw: share * yaw + own * motion.yaw, pitch: share * pitch + own * motion.pitch };
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
  /** How the eyes are turned in the head. */
  readonly eyes: Look = { yaw: 0, pitch: 0 };
  /** Whether the last step turned more than the eyes. */
  isTurned = false;
  private readonly now: Turn = { yaw: 0, pitch: 0, roll: 0 };
  private readonly glance: Look = { yaw: 0, pitch: 0 };
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
   * @param motion How the motion turns her eyes in the head.
   */
  update(seconds: number, bearing: Bearing, viewer: Vector3, motion: Look): boolean {
    this.time += seconds;
    const wish = wished(bearing, viewer);
    const lives = this.breathes();
    if (lives && bearing !== "busy") this.look();
    else this.glance.yaw = this.glance.pitch = 0;
    let moved = lives;
    const ease = (now: number, wish: number, rate: number): number => {
      const left = wish - now;
      if (Math.abs(left) < LEAST) return now;
      moved = true;
      return now + left * (1 - Math.exp(-rate * seconds));
    };
    for (const key of ["yaw", "pitch", "roll"] as const) this.now[key] = ease(this.now[key], wish[key], EASE);
    this.isTurned = moved;
    const line = lookedAt(bearing, viewer, motion, wish);
    for (const key of ["yaw", "pitch"] as const) {
      const turn = within(MOST_EYES, line[key] - this.now[key]) + this.glance[key];
      this.eyes[key] = ease(this.eyes[key], turn, EYES_EASE);
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
