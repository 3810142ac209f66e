// A scene as data: what the server's scene files hold, read so that nothing is missing later.

import { fields, list, number, text } from "../reading.ts";

export type Two = [number, number];
export type Three = [number, number, number];

export interface PlacedFurniture {
  name: string;
  asset: string;
  position: Two;
  yaw_deg: number;
}

export interface PlacedObject {
  id: number;
  asset: string;
  /** Furniture name, "furniture/level" where it has several levels, or "floor". */
  on: string;
  position: Two;
  yaw_deg: number;
}

export interface FloorArea {
  name: string;
  kind: string;
  min: Two;
  max: Two;
}

export interface SceneLight {
  position: Three;
  target: Three;
  diffuse: number;
  shadow: boolean;
}

export interface SceneData {
  name: string;
  title: string;
  room: { asset: string; x_min: number; x_max: number; y_min: number; y_max: number; height_m: number };
  agent: { position: Two; heading_deg: number; gaze: Three };
  lights: SceneLight[];
  furniture: PlacedFurniture[];
  objects: PlacedObject[];
  areas: FloorArea[];
  ambient: number;
  variation: number;
}

/** A level that carries things, in the frame of its furniture. */
export interface Surface {
  name: string;
  center: Three;
  half_size: Two;
}

export interface Asset {
  name: string;
  size: Three;
  surfaces: Surface[];
}

export interface Catalog {
  furniture: Map<string, Asset>;
  objects: Map<string, Asset>;
}

export interface Finding {
  severity: "error" | "warning";
  where: string;
  problem: string;
  fix: string;
}

/** What is selected, or what a finding is about. */
export interface Ref {
  kind: "furniture" | "objects" | "areas" | "lights" | "agent";
  /** Its place in the list; 0 where there is one alone. */
  index: number;
}

export const isSame = (a: Ref | null, b: Ref | null): boolean => a?.kind === b?.kind && a?.index === b?.index;
export const keyOf = (ref: Ref): string => `${ref.kind}/${ref.index}`;

const two = (value: unknown): Two => [number(list(value)[0]), number(list(value)[1])];
const three = (value: unknown): Three => [...two(value), number(list(value)[2])];

export function readScene(value: unknown): SceneData {
  const from = fields(value);
  const room = fields(from.room);
  const agent = fields(from.agent);
  const each = <T>(items: unknown, read: (item: Record<string, unknown>) => T): T[] => list(items).map(fields).map(read);
  return {
    name: text(from.name),
    title: text(from.title),
    room: {
      asset: text(room.asset),
      x_min: number(room.x_min, -3),
      x_max: number(room.x_max, 3),
      y_min: number(room.y_min, -3),
      y_max: number(room.y_max, 3),
      height_m: number(room.height_m, 3),
    },
    agent: { position: two(agent.position), heading_deg: number(agent.heading_deg), gaze: three(agent.gaze) },
    lights: each(from.lights, (light) => ({
      position: three(light.position),
      target: three(light.target),
      diffuse: number(light.diffuse),
      shadow: light.shadow === true,
    })),
    furniture: each(from.furniture, (piece) => ({
      name: text(piece.name),
      asset: text(piece.asset),
      position: two(piece.position),
      yaw_deg: number(piece.yaw_deg),
    })),
    objects: each(from.objects, (item) => ({
      id: number(item.id),
      asset: text(item.asset),
      on: text(item.on),
      position: two(item.position),
      yaw_deg: number(item.yaw_deg),
    })),
    areas: each(from.areas, (area) => ({ name: text(area.name), kind: text(area.kind), min: two(area.min), max: two(area.max) })),
    ambient: number(from.ambient, 0.54),
    variation: number(from.variation),
  };
}

function readAssets(value: unknown): Map<string, Asset> {
  const assets = list(value).map(fields).map((item): Asset => ({
    name: text(item.name),
    size: three(item.size),
    surfaces: list(item.surfaces)
      .map(fields)
      .map((surface) => ({ name: text(surface.name), center: three(surface.center), half_size: two(surface.half_size) })),
  }));
  return new Map(assets.map((asset) => [asset.name, asset]));
}

export function readCatalog(value: unknown): Catalog {
  const from = fields(value);
  return { furniture: readAssets(from.furniture), objects: readAssets(from.objects) };
}

export function readFindings(value: unknown): Finding[] {
  return list(value)
    .map(fields)
    .map((item) => ({
      severity: item.severity === "warning" ? "warning" : "error",
      where: text(item.where),
      problem: text(item.problem),
      fix: text(item.fix),
    }));
}

const words = (asset: string): string => asset.replaceAll("_", " ");

/** An asset's name as one says it. */
export const assetWords = (asset: string): string => words(asset).replace(/^./, (first) => first.toUpperCase());

/** What something is called on the page; empty if there is no such thing. */
export function nameOf(data: SceneData, { kind, index }: Ref): string {
  if (kind === "agent") return "Where she starts";
  if (kind === "lights") return data.lights[index] ? `Light ${index + 1}` : "";
  if (kind === "areas") return data.areas[index]?.name ?? "";
  if (kind === "furniture") return data.furniture[index]?.name ?? "";
  const item = data.objects[index];
  return item ? `${assetWords(item.asset)} ${item.id}` : "";
}

/** The thing that a finding is about; null if it is about the whole. */
export function targetOf(where: string, data: SceneData): Ref | null {
  const [, kind, index] = /^(furniture|objects|areas|lights)(?:\[(\d+)\])?/.exec(where) ?? [];
  const ref: Ref | null = kind
    ? { kind: kind as Ref["kind"], index: Number(index ?? (kind === "lights" ? 0 : -1)) }
    : where.startsWith("agent")
      ? { kind: "agent", index: 0 }
      : null;
  return ref && nameOf(data, ref) ? ref : null;
}
