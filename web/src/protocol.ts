// What the server and the page tell each other. World frame: right-handed, z up, metres, radians.

export interface Point {
  x: number;
  y: number;
  z: number;
}

export interface SceneObject {
  id: number;
  class_name: string;
  tag: string;
  size: [number, number, number];
  node: string;
}

export interface Furniture {
  name: string;
  node: string;
  center: [number, number, number];
  size: [number, number, number];
}

export interface SceneShape {
  name: string;
  title: string;
  x_min: number;
  x_max: number;
  y_min: number;
  y_max: number;
  height_m: number;
  /** Address of the mesh; empty if there is none to be had. */
  glb: string;
  objects: SceneObject[];
  furniture: Furniture[];
}

export interface BodyShape {
  reach_m: number;
  reach_top_m: number;
  radius_m: number;
  eye_height_m: number;
  fov_y_rad: number;
}

/** The first message of a track: what is shown, and by whom it is moved. */
export interface Hello {
  type: "hello";
  n: number;
  t: number;
  room?: string;
  run?: string;
  settings: Record<string, unknown>;
  scene: SceneShape;
  body: BodyShape;
  figure: { name: string; glb: string };
  joints: string[];
  rate: number;
  live: boolean;
  controls: string[];
}

/** The place and rotation of a thing: x, y, z, then a unit quaternion x, y, z, w. */
export type Placed = [number, number, number, number, number, number, number];

export interface Pose {
  type: "pose";
  n: number;
  t: number;
  /** x, y, heading. */
  body: [number, number, number];
  /** Joint 0 in the body frame. */
  pelvis: [number, number, number];
  /** A unit quaternion x, y, z, w for every joint, relative to its parent. */
  joints: number[];
  /** How the eyes are turned in the head, radians: left, down. */
  eyes: [number, number];
  held: number | null;
  things: Record<string, Placed>;
  gone?: number[];
  /** How bright each light is, 0 to 1. */
  lights?: number[];
}

export interface ObservedObject {
  tag: string;
  position: Point;
  box: [number, number, number, number];
  pixels: number;
}

export interface ReferencePoint {
  tag: string;
  position: Point;
  pixel: [number, number];
}

export interface Call {
  id: string;
  name: string;
  arguments: Record<string, unknown>;
  note: string;
  confidence: number | null;
}

/** One event of a run's record, with what the page needs of it and nothing that could be missing. */
export type RunEvent =
  | { type: "started"; instruction: string }
  | {
      type: "observed";
      step: number;
      width_px: number;
      height_px: number;
      objects: ObservedObject[];
      points: ReferencePoint[];
      held: string;
    }
  | {
      type: "thought";
      step: number;
      note: string;
      calls: Call[];
      unreadable: string;
      tokens: [number, number];
      usd: number | null;
      seconds: number;
      messages: number;
      state_text: string;
    }
  | {
      type: "acted";
      step: number;
      call_id: string;
      name: string;
      arguments: Record<string, unknown>;
      outcome: string;
      code: string;
      text: string;
    }
  | { type: "left_out"; step: number; call_id: string; name: string; why: string }
  | { type: "shown"; step: number; width_px: number; height_px: number }
  | { type: "happened"; step: number; what: string; object_id: number | null; by_user: boolean }
  | { type: "vetoed"; step: number; why: string }
  | { type: "restored"; step: number }
  | { type: "lost"; step: number }
  | { type: "ended"; steps: number; reason: string; answer: string; why: string }
  | { type: "other"; name: string };

export interface EventMessage {
  type: "event";
  n: number;
  t: number;
  event: RunEvent;
  /** Address of a picture; empty for none. */
  frame: string;
}

export const DOINGS = [
  "idle",
  "seeing",
  "thinking",
  "acting",
  "asking",
  "waiting_for_you",
  "closed",
] as const;
export type Doing = (typeof DOINGS)[number];

export interface Status {
  type: "status";
  n: number;
  t: number;
  doing: Doing;
  speed: number;
  spent: { input_tokens: number; output_tokens: number; usd: number | null };
  can_undo: boolean;
}

export interface Asked {
  type: "asked";
  n: number;
  t: number;
  calls: { name: string; arguments: Record<string, unknown> }[];
  note: string;
}

export interface Notice {
  type: "notice";
  n: number;
  t: number;
  text: string;
  level: "info" | "warning" | "error";
}

export type Message = Hello | Pose | EventMessage | Status | Asked | Notice;

/** What the page may say. */
export type Said =
  | { type: "say"; text: string }
  | { type: "stop" }
  | { type: "undo" }
  | { type: "move"; object_id: number; point: [number, number, number] }
  | { type: "act"; name: string; arguments: Record<string, unknown> }
  | { type: "finish"; answer: string }
  | { type: "approve" }
  | { type: "veto"; why: string }
  | { type: "approval"; on: boolean }
  | { type: "speed"; factor: number }
  | { type: "ping" };

export interface ModelOffer {
  name: string;
  note: string;
  needs_key: boolean;
  has_key: boolean;
}

export interface RunOffer {
  name: string;
  instruction: string;
  model: string;
  completion: number | null;
  when: string;
}

/** What can be started, and what can be replayed. */
export interface Offer {
  scenes: { name: string; title: string }[];
  tasks: { id: string; instruction: string; scenes: string[] }[];
  models: ModelOffer[];
  profiles: string[];
  labelings: string[];
  figures: string[];
  runs: RunOffer[];
}

export interface RoomWish {
  scene: string;
  model: string;
  profile: string;
  labeling: string;
  figure: string;
  task: string | null;
  variation: number;
  approve: boolean;
}
