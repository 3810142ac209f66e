// The scene that is edited: every edit makes a new one, so that it can be undone.

import { Changes } from "../show.ts";
import { isSame, nameOf, type PlacedObject, type Ref, type SceneData, type Three, type Two } from "./scene.ts";
import { FLOOR, pieceOf, radians, turned } from "./support.ts";

const MOST_UNDONE = 200;
const MOST_ID = 9999;
/** A scene has at least one light, and at most so many. */
export const MOST_LIGHTS = 6;
/** An area is at least so wide and so deep, metres. */
const LEAST_AREA_M = 0.1;
/** Below the ceiling, metres. */
const LIGHT_BELOW_M = 0.1;

/** A corner of an area: which of its edges meet there, across x and across y. */
export type Corner = readonly ["min" | "max", "min" | "max"];

/** To the centimetre and the degree: what a hand means. */
export const cm = (value: number): number => Math.round(value * 100) / 100 + 0;

/** The same direction between -180 and 180 degrees. */
export const upright = (degrees: number): number => {
  const turn = ((((degrees + 180) % 360) + 360) % 360) - 180;
  return (turn === -180 ? 180 : turn) + 0;
};

export class Draft {
  readonly changes = new Changes();
  private past: SceneData[] = [];
  private future: SceneData[] = [];
  private lastKey = "";
  private ref: Ref | null = null;

  constructor(private now: SceneData) {}

  get data(): SceneData {
    return this.now;
  }

  get selected(): Ref | null {
    return this.ref;
  }

  get canUndo(): boolean {
    return this.past.length > 0;
  }

  get canRedo(): boolean {
    return this.future.length > 0;
  }

  select(ref: Ref | null): void {
    if (isSame(ref, this.ref)) return;
    this.ref = ref && nameOf(this.now, ref) ? ref : null;
    this.settle();
    this.changes.tell();
  }

  /**
   * Change the scene.
   * @param key Edits of one key that follow each other are undone at once, e.g. those of one drag; empty for an edit of its own.
   */
  edit(change: (data: SceneData) => void, key = ""): void {
    const next = structuredClone(this.now);
    change(next);
    if (JSON.stringify(next) === JSON.stringify(this.now)) return;
    if (!key || key !== this.lastKey) this.past.push(this.now);
    if (this.past.length > MOST_UNDONE) this.past.shift();
    this.lastKey = key;
    this.future = [];
    this.become(next);
  }

  /** What comes now is an edit of its own, even if it has the same key. */
  settle(): void {
    this.lastKey = "";
  }

  undo(): void {
    this.step(this.past, this.future);
  }

  redo(): void {
    this.step(this.future, this.past);
  }

  private step(from: SceneData[], to: SceneData[]): void {
    const next = from.pop();
    if (!next) return;
    to.push(this.now);
    this.settle();
    // Numbers in a list that becomes longer or shorter may stand for other things then.
    if (this.ref && countOf(next, this.ref) !== countOf(this.now, this.ref)) this.ref = null;
    this.become(next);
  }

  private become(next: SceneData): void {
    this.now = next;
    if (this.ref && !nameOf(next, this.ref)) this.ref = null;
    this.changes.tell();
  }

  /** Put something at a place of the floor plane; what stands on furniture comes along. */
  place(ref: Ref, [x, y]: Two, on = "", key = ""): void {
    this.edit((data) => {
      if (ref.kind === "agent") data.agent.position = [cm(x), cm(y)];
      else if (ref.kind === "objects") {
        const item = data.objects[ref.index];
        if (item) Object.assign(item, { position: [cm(x), cm(y)], on: on || item.on });
      } else if (ref.kind === "furniture") moveFurniture(data, ref.index, [cm(x), cm(y)]);
      else if (ref.kind === "areas") moveArea(data, ref.index, [x, y]);
      else {
        moveLight(data, ref.index, [cm(x), cm(y)]);
      }
    }, key);
  }

  /** Put a corner of an area somewhere; the one across stays where it is. */
  reshape(index: number, corner: Corner, at: Two, key = ""): void {
    this.edit(({ areas: { [index]: area } }) => {
      if (!area) return;
      for (const axis of [0, 1] as const) {
        if (corner[axis] === "min") area.min[axis] = cm(Math.min(at[axis], area.max[axis] - LEAST_AREA_M));
        else area.max[axis] = cm(Math.max(at[axis], area.min[axis] + LEAST_AREA_M));
      }
    }, key);
  }

  /** Turn something by so many degrees, counter-clockwise as seen from above. */
  turn(ref: Ref, degrees: number, key = ""): void {
    this.edit((data) => {
      if (ref.kind === "agent") turnAgent(data, degrees);
      else if (ref.kind === "furniture") turnFurniture(data, ref.index, degrees);
      else if (ref.kind === "objects") {
        const item = data.objects[ref.index];
        if (item) item.yaw_deg = upright(item.yaw_deg + degrees);
      }
    }, key);
  }

  /** Take something out. What stood on it comes to the floor; where she starts stays. */
  remove(ref: Ref): void {
    const name = nameOf(this.now, ref);
    if (ref.kind === "agent" || !name) return;
    if (ref.kind === "lights" && this.now.lights.length === 1) return;
    this.ref = null;
    const kind = ref.kind;
    this.edit((data) => {
      data[kind].splice(ref.index, 1);
      if (kind !== "furniture") return;
      for (const item of data.objects) if (pieceOf(item.on) === name) item.on = FLOOR;
    });
  }

  addObject(asset: string, on: string, [x, y]: Two): void {
    const id = freeId(this.now.objects);
    this.add("objects", (data) => data.objects.push({ id, asset, on, position: [cm(x), cm(y)], yaw_deg: 0 }));
  }

  addFurniture(asset: string, [x, y]: Two): void {
    const name = freeName(asset, [FLOOR, ...this.now.furniture.map((piece) => piece.name)]);
    this.add("furniture", (data) => data.furniture.push({ name, asset, position: [cm(x), cm(y)], yaw_deg: 0 }));
  }

  addArea([x, y]: Two): void {
    const name = freeName("area", this.now.areas.map((area) => area.name));
    const corners: { min: Two; max: Two } = { min: [cm(x - 0.5), cm(y - 0.5)], max: [cm(x + 0.5), cm(y + 0.5)] };
    this.add("areas", (data) => data.areas.push({ name, kind: "area", ...corners }));
  }

  /** A light under the ceiling that shines straight down. */
  addLight([x, y]: Two): void {
    if (this.now.lights.length >= MOST_LIGHTS) return;
    const [left, ahead, up] = [cm(x), cm(y), cm(this.now.room.height_m - LIGHT_BELOW_M)];
    this.add("lights", (data) => data.lights.push({ position: [left, ahead, up], target: [left, ahead, 0], diffuse: 0.3, shadow: false }));
  }

  private add(kind: "objects" | "furniture" | "areas" | "lights", change: (data: SceneData) => void): void {
    this.ref = { kind, index: this.now[kind].length };
    this.edit(change);
  }

  /** Give furniture another name; what stands on it follows. */
  rename(index: number, name: string): void {
    this.edit((data) => {
      const piece = data.furniture[index];
      if (!piece) return;
      const old = piece.name;
      piece.name = name;
      for (const item of data.objects) if (pieceOf(item.on) === old) item.on = item.on.replace(old, name);
    }, `rename ${index}`);
  }
}

/** The corner of an area that is nearest to a point of the floor; null if none is near. */
export function cornerAt(data: SceneData, ref: Ref | null, [x, y]: Two, near: number): Corner | null {
  const area = ref?.kind === "areas" ? data.areas[ref.index] : undefined;
  if (!area) return null;
  const side = (axis: 0 | 1, value: number): "min" | "max" => (Math.abs(value - area.min[axis]) <= Math.abs(value - area.max[axis]) ? "min" : "max");
  const corner: Corner = [side(0, x), side(1, y)];
  return Math.hypot(x - area[corner[0]][0], y - area[corner[1]][1]) <= near ? corner : null;
}

/** Where something is on the floor plane; null if there is no such thing. */
export function placeOf(data: SceneData, { kind, index }: Ref): Two | null {
  if (kind === "agent") return data.agent.position;
  if (kind === "areas") {
    const area = data.areas[index];
    return area ? [(area.min[0] + area.max[0]) / 2, (area.min[1] + area.max[1]) / 2] : null;
  }
  const at = data[kind][index]?.position;
  return at ? [at[0], at[1]] : null;
}

const countOf = (data: SceneData, { kind }: Ref): number => (kind === "agent" ? 1 : data[kind].length);
const ridersOf = (data: SceneData, name: string): PlacedObject[] => data.objects.filter(({ on }) => pieceOf(on) === name);

function moveFurniture(data: SceneData, index: number, [x, y]: Two): void {
  const piece = data.furniture[index];
  if (!piece) return;
  const [dx, dy] = [x - piece.position[0], y - piece.position[1]];
  for (const rider of ridersOf(data, piece.name)) rider.position = [mm(rider.position[0] + dx), mm(rider.position[1] + dy)];
  piece.position = [x, y];
}

function turnFurniture(data: SceneData, index: number, degrees: number): void {
  const piece = data.furniture[index];
  if (!piece) return;
  const [px, py] = piece.position;
  for (const rider of ridersOf(data, piece.name)) {
    const [dx, dy] = turned([rider.position[0] - px, rider.position[1] - py], radians(degrees));
    rider.position = [mm(px + dx), mm(py + dy)];
    rider.yaw_deg = upright(rider.yaw_deg + degrees);
  }
  piece.yaw_deg = upright(piece.yaw_deg + degrees);
}

/** She looks elsewhere then, as far away as before. */
function turnAgent(data: SceneData, degrees: number): void {
  const { agent } = data;
  const [x, y] = agent.position;
  const [dx, dy] = turned([agent.gaze[0] - x, agent.gaze[1] - y], radians(degrees));
  agent.gaze = [mm(x + dx), mm(y + dy), agent.gaze[2]] as Three;
  agent.heading_deg = upright(agent.heading_deg + degrees);
}

/** It goes on shining the same way. */
function moveLight(data: SceneData, index: number, [x, y]: Two): void {
  const light = data.lights[index];
  if (!light) return;
  const [px, py, z] = light.position;
  light.target = [mm(light.target[0] + x - px), mm(light.target[1] + y - py), light.target[2]];
  light.position = [x, y, z];
}

function moveArea(data: SceneData, index: number, [x, y]: Two): void {
  const area = data.areas[index];
  if (!area) return;
  const half: Two = [(area.max[0] - area.min[0]) / 2, (area.max[1] - area.min[1]) / 2];
  area.min = [cm(x - half[0]), cm(y - half[1])];
  area.max = [cm(x + half[0]), cm(y + half[1])];
}

const mm = (value: number): number => Math.round(value * 1000) / 1000 + 0;

function freeId(objects: readonly PlacedObject[]): number {
  const taken = new Set(objects.map(({ id }) => id));
  let id = Math.max(-1, ...taken) + 1;
  if (id > MOST_ID) for (id = 0; taken.has(id); ) id++;
  return id;
}

function freeName(wish: string, taken: readonly string[]): string {
  let name = wish;
  for (let count = 2; taken.includes(name); count++) name = `${wish} ${count}`;
  return name;
}
