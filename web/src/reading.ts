// Reads messages that came from outside. What is missing or wrong becomes empty, never an error later.

import {
  DOINGS,
  type Call,
  type Doing,
  type EventMessage,
  type Furniture,
  type Hello,
  type Message,
  type ObservedObject,
  type Placed,
  type Point,
  type Pose,
  type ReferencePoint,
  type RunEvent,
  type SceneObject,
} from "./protocol.ts";

type Fields = Record<string, unknown>;

export const fields = (value: unknown): Fields =>
  typeof value === "object" && value !== null && !Array.isArray(value) ? (value as Fields) : {};
export const list = (value: unknown): unknown[] => (Array.isArray(value) ? value : []);
export const text = (value: unknown): string =>
  typeof value === "string" ? value : typeof value === "number" ? String(value) : "";
export const number = (value: unknown, otherwise = 0): number =>
  typeof value === "number" && Number.isFinite(value) ? value : otherwise;

const numberOrNull = (value: unknown): number | null =>
  typeof value === "number" && Number.isFinite(value) ? value : null;
const numbers = (value: unknown): number[] => list(value).map((item) => number(item));
const three = (value: unknown): [number, number, number] => {
  const [x = 0, y = 0, z = 0] = numbers(value);
  return [x, y, z];
};
const point = (value: unknown): Point => {
  const { x, y, z } = fields(value);
  return { x: number(x), y: number(y), z: number(z) };
};

/** A message of the server; null for what is none. */
export function readMessage(value: unknown): Message | null {
  const from = fields(value);
  const head = { n: number(from.n), t: number(from.t) };
  switch (from.type) {
    case "hello":
      return { ...head, ...readHello(from) };
    case "pose":
      return readPose(from, head);
    case "event": {
      const message: EventMessage = {
        ...head,
        type: "event",
        event: readEvent(from.event),
        frame: text(from.frame),
      };
      return message;
    }
    case "status": {
      const spent = fields(from.spent);
      const doing = DOINGS.includes(from.doing as Doing) ? (from.doing as Doing) : "idle";
      return {
        ...head,
        type: "status",
        doing,
        speed: number(from.speed, 1),
        spent: {
          input_tokens: number(spent.input_tokens),
          output_tokens: number(spent.output_tokens),
          usd: numberOrNull(spent.usd),
        },
        can_undo: from.can_undo === true,
      };
    }
    case "asked":
      return {
        ...head,
        type: "asked",
        note: text(from.note),
        calls: list(from.calls)
          .map(fields)
          .map((call) => ({ name: text(call.name), arguments: fields(call.arguments) })),
      };
    case "notice": {
      const level = from.level === "error" || from.level === "warning" ? from.level : "info";
      return { ...head, type: "notice", text: text(from.text), level };
    }
    default:
      return null;
  }
}

function readHello(from: Fields): Hello {
  const scene = fields(from.scene);
  const body = fields(from.body);
  const objects: SceneObject[] = list(scene.objects)
    .map(fields)
    .map((item) => ({
      id: number(item.id),
      class_name: text(item.class_name),
      tag: text(item.tag),
      size: three(item.size),
      node: text(item.node),
    }));
  const furniture: Furniture[] = list(scene.furniture)
    .map(fields)
    .map((item) => ({
      name: text(item.name),
      node: text(item.node),
      center: three(item.center),
      size: three(item.size),
    }));
  return {
    type: "hello",
    n: number(from.n),
    t: number(from.t),
    room: text(from.room) || undefined,
    run: text(from.run) || undefined,
    settings: fields(from.settings),
    scene: {
      name: text(scene.name),
      title: text(scene.title),
      x_min: number(scene.x_min, -3),
      x_max: number(scene.x_max, 3),
      y_min: number(scene.y_min, -3),
      y_max: number(scene.y_max, 3),
      height_m: number(scene.height_m, 3),
      glb: text(scene.glb),
      objects,
      furniture,
    },
    body: {
      reach_m: number(body.reach_m, 0.9),
      reach_top_m: number(body.reach_top_m, 2),
      radius_m: number(body.radius_m, 0.25),
      eye_height_m: number(body.eye_height_m, 1.6),
      fov_y_rad: number(body.fov_y_rad, 1.2),
    },
    figure: { name: text(fields(from.figure).name), glb: text(fields(from.figure).glb) },
    joints: list(from.joints).map(text),
    rate: number(from.rate, 30),
    live: from.live === true,
    controls: list(from.controls).map(text),
  };
}

function readPose(from: Fields, head: { n: number; t: number }): Pose {
  const things: Record<string, Placed> = {};
  for (const [id, placed] of Object.entries(fields(from.things))) {
    const read = numbers(placed);
    if (read.length === 7) things[id] = read as Placed;
  }
  const pose: Pose = {
    ...head,
    type: "pose",
    body: three(from.body),
    pelvis: three(from.pelvis),
    joints: numbers(from.joints),
    eyes: [number(list(from.eyes)[0]), number(list(from.eyes)[1])],
    held: numberOrNull(from.held),
    things,
  };
  if (Array.isArray(from.gone)) pose.gone = numbers(from.gone);
  if (Array.isArray(from.lights)) pose.lights = numbers(from.lights);
  return pose;
}

function readEvent(value: unknown): RunEvent {
  const from = fields(value);
  const step = number(from.step);
  switch (from.type) {
    case "started":
      return { type: "started", instruction: text(from.instruction) };
    case "observed":
      return {
        type: "observed",
        step,
        width_px: number(from.width_px, 1),
        height_px: number(from.height_px, 1),
        objects: list(from.objects).map(readObserved),
        points: list(from.points).map(readReference),
        held: text(fields(from.agent).held),
      };
    case "thought":
      return readThought(from, step);
    case "acted": {
      const feedback = fields(from.feedback);
      return {
        type: "acted",
        step,
        call_id: text(from.call_id),
        name: text(from.name),
        arguments: fields(from.arguments),
        outcome: text(feedback.outcome),
        code: text(feedback.code),
        text: text(feedback.text),
      };
    }
    case "left_out":
      return {
        type: "left_out",
        step,
        call_id: text(from.call_id),
        name: text(from.name),
        why: text(from.why),
      };
    case "shown":
      return { type: "shown", step, width_px: number(from.width_px, 1), height_px: number(from.height_px, 1) };
    case "happened":
      return { type: "happened", step, ...readHappening(fields(from.event)), by_user: from.by_user === true };
    case "vetoed":
      return { type: "vetoed", step, why: text(from.why) };
    case "restored":
      return { type: "restored", step };
    case "lost":
      return { type: "lost", step };
    case "ended":
      return {
        type: "ended",
        steps: number(from.steps),
        reason: text(from.reason),
        answer: text(from.answer),
        why: text(from.why),
      };
    default:
      return { type: "other", name: text(from.type) };
  }
}

function readObserved(value: unknown): ObservedObject {
  const from = fields(value);
  const [left = 0, top = 0, right = 0, bottom = 0] = numbers(from.box_px);
  return {
    tag: text(from.tag),
    position: point(from.position),
    box: [left, top, right, bottom],
    pixels: number(from.pixels),
  };
}

function readReference(value: unknown): ReferencePoint {
  const from = fields(value);
  const [u = 0, v = 0] = numbers(from.pixel);
  return { tag: text(from.tag), position: point(from.position), pixel: [u, v] };
}

function readThought(from: Fields, step: number): RunEvent {
  const turn = fields(from.turn);
  const reply = fields(turn.reply);
  const message = fields(reply.message);
  const usage = fields(reply.usage);
  const calls: Call[] = list(turn.wishes)
    .map(fields)
    .map((wish) => {
      const call = fields(wish.call);
      return {
        id: text(call.id),
        name: text(call.name),
        arguments: fields(wish.arguments),
        note: text(wish.note),
        confidence: numberOrNull(wish.confidence),
      };
    });
  const notes = [...new Set(calls.map((call) => call.note.trim()).filter(Boolean))];
  return {
    type: "thought",
    step,
    note: text(message.text).trim() || notes.join("\n"),
    calls,
    unreadable: text(reply.unreadable),
    tokens: [number(usage.input_tokens), number(usage.output_tokens)],
    usd: numberOrNull(reply.cost_usd),
    seconds: number(reply.seconds),
    messages: number(from.messages),
    state_text: text(from.state_text),
  };
}

function readHappening(from: Fields): { what: string; object_id: number | null } {
  return { what: text(from.type), object_id: numberOrNull(from.object_id) };
}
