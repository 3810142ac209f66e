// What carries what: levels of furniture in the world's frame, and free places on them.

import type { Catalog, PlacedFurniture, SceneData, Three, Two } from "./scene.ts";

export const FLOOR = "floor";
const NEAR_M = 0.12;
/** A point belongs to a level that is at most so far above or below it. */
const STEP_M = 0.06;

/** A level in the world's frame. */
export interface Level {
  support: string;
  center: Three;
  half: Two;
  yaw: number;
}

export const radians = (degrees: number): number => (degrees * Math.PI) / 180;

/** Turn a vector of the floor plane. */
export function turned([x, y]: Two, angle: number): Two {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [c * x - s * y, s * x + c * y];
}

/** The furniture that a support is of. */
export const pieceOf = (support: string): string => support.split("/")[0] ?? "";

export function levelsOf(piece: PlacedFurniture, catalog: Catalog): Level[] {
  const yaw = radians(piece.yaw_deg);
  return (catalog.furniture.get(piece.asset)?.surfaces ?? []).map(({ name, center, half_size }) => {
    const [dx, dy] = turned([center[0], center[1]], yaw);
    return {
      support: name ? `${piece.name}/${name}` : piece.name,
      center: [piece.position[0] + dx, piece.position[1] + dy, center[2]],
      half: half_size,
      yaw,
    };
  });
}

export function levels(data: SceneData, catalog: Catalog): Level[] {
  const { x_min, x_max, y_min, y_max } = data.room;
  const floor: Level = {
    support: FLOOR,
    center: [(x_min + x_max) / 2, (y_min + y_max) / 2, 0],
    half: [(x_max - x_min) / 2, (y_max - y_min) / 2],
    yaw: 0,
  };
  return [floor, ...data.furniture.flatMap((piece) => levelsOf(piece, catalog))];
}

function isOn(level: Level, [x, y]: Two): boolean {
  const [u, v] = turned([x - level.center[0], y - level.center[1]], -level.yaw);
  return Math.abs(u) <= level.half[0] && Math.abs(v) <= level.half[1];
}

/** The level that a point of the picture is on; null for a place that carries nothing. */
export function levelAt(data: SceneData, catalog: Catalog, [x, y, z]: Three): Level | null {
  const near = levels(data, catalog)
    .filter((level) => isOn(level, [x, y]) && Math.abs(level.center[2] - z) < NEAR_M)
    .sort((a, b) => Math.abs(a.center[2] - z) - Math.abs(b.center[2] - z));
  return near[0] ?? null;
}

/** How high the top of a support is; 0 for one that there is not. */
export const heightOf = (support: string, data: SceneData, catalog: Catalog): number =>
  levels(data, catalog).find((level) => level.support === support)?.center[2] ?? 0;

const radius = (asset: string, catalog: Catalog): number => {
  const [x, y] = catalog.objects.get(asset)?.size ?? [0.1, 0.1];
  return Math.hypot(x, y) / 2;
};

/** A place on a level, near to a wish, where an object meets no other one; the wish if there is none. */
export function freeSpot(data: SceneData, catalog: Catalog, asset: string, level: Level, wish: Two): Two {
  const own = radius(asset, catalog);
  const others = data.objects.filter(({ on }) => on === level.support);
  for (let ring = 0; ring < 24; ring++) {
    for (let step = 0; step < Math.max(1, ring * 6); step++) {
      const [dx, dy] = turned([ring * STEP_M, 0], (step / Math.max(1, ring * 6)) * 2 * Math.PI);
      const at: Two = [wish[0] + dx, wish[1] + dy];
      const inner = { ...level, half: level.half.map((half) => Math.max(0, half - own)) as Two };
      const isFree = others.every(({ asset: other, position: [x, y] }) => Math.hypot(x - at[0], y - at[1]) > own + radius(other, catalog));
      if (isFree && isOn(inner, at)) return at;
    }
  }
  return wish;
}
