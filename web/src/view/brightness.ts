// How bright a place of the room is: the lamp near the ceiling, the day from the window, and what all
// surfaces give back. The lights of the full look stand where these do.

import { Color, Vector3 } from "three";
import type { SceneShape } from "../protocol.ts";
import { type Ambience, DIRECT_SHARE, openShare } from "./ambience.ts";
import { BodyLight, type Ray } from "./bodylight.ts";
import { CELL_M, type Voxels } from "./voxels.ts";

/** How far a room reaches. */
export type Extent = Pick<SceneShape, "x_min" | "x_max" | "y_min" | "y_max" | "height_m">;

export const LAMP = { colour: new Color(0xfff0dc), strength: 1.75, angle: 1.28, penumbra: 0.9 } as const;
export const DAY = { colour: new Color(0xf3f6ff), strength: 0.55 } as const;
export const GLOW = { colour: DAY.colour, strength: 1.3, reach: 5, decay: 1.2 } as const;
const SKY_SHARE = 1.55;
/** The lamp is as wide as this to each side, so that shadows have soft edges. */
const LAMP_HALF_M = 0.22;
const LAMP_SPOTS = [[-1, -0.4], [0.4, -1], [1, 0.4], [-0.4, 1]].map(([x = 0, y = 0]) => new Vector3(x, y, 0).multiplyScalar(LAMP_HALF_M));
/** So near the lamp nothing is in the way. */
const LAMP_OWN_M = 0.3;
/** Cosines between which the lamp fades out. */
const [OUTER, INNER] = [Math.cos(LAMP.angle), Math.cos(LAMP.angle * (1 - LAMP.penumbra))];

/** Where the light of a room comes from. */
export interface Sources {
  lamp: Vector3;
  middle: Vector3;
  day: Vector3;
  glow: Vector3;
  /** From the middle of the room to its bright side. */
  bright: Vector3;
}

/** @param window Where the window is; null if there is none. */
export function sourcesOf(scene: Extent, window: Vector3 | null): Sources {
  const middle = new Vector3((scene.x_min + scene.x_max) / 2, (scene.y_min + scene.y_max) / 2, 0);
  const [width, depth] = [scene.x_max - scene.x_min, scene.y_max - scene.y_min];
  const from = window ?? new Vector3(scene.x_max, middle.y, scene.height_m * 0.6);
  return {
    middle,
    lamp: new Vector3(middle.x - width * 0.16, middle.y - depth * 0.1, scene.height_m - 0.08),
    day: from.clone().lerp(new Vector3(middle.x, middle.y, scene.height_m * 2), 0.25),
    glow: from.clone().lerp(new Vector3(middle.x, middle.y, 1.6), 0.14),
    bright: from.clone().sub(middle).setZ(0).normalize(),
  };
}

const side = (way: Vector3, [r, g, b]: readonly [number, number, number], share: number): Ray => ({
  way,
  light: new Vector3(r, g, b).multiplyScalar(share * SKY_SHARE),
});

/** The surroundings in a few numbers: bright above, warm below, cool at the window. */
export function sidesOf({ bright }: Sources): readonly Ray[] {
  return [
    side(new Vector3(0, 0, 1), [1, 0.96, 0.9], 1.15),
    side(new Vector3(0, 0, -1), [0.62, 0.5, 0.4], 0.5),
    side(bright, [0.95, 0.98, 1], 0.75),
    side(bright.clone().negate(), [0.8, 0.72, 0.62], 0.4),
  ];
}

const smooth = (low: number, high: number, x: number): number => {
  const t = Math.min(1, Math.max(0, (x - low) / (high - low)));
  return t * t * (3 - 2 * t);
};

/** What is left of the surroundings where the lights are dimmed. */
export const skyOf = (share: number): number => 0.25 + 0.75 * share;

export class Brightness {
  readonly sources: Sources;
  private readonly sides: readonly Ray[];
  /** The same as numbers: the way to each, and its colour. */
  private readonly wide: Float64Array;
  /** Ways in which the lamp shines, and to the day. */
  private readonly down: Vector3;
  private readonly day: Vector3;
  private readonly way = new Vector3();
  private readonly spots: readonly Vector3[];

  constructor(
    scene: Extent,
    window: Vector3 | null,
    private readonly voxels: Voxels,
    private readonly ambience: Ambience,
  ) {
    this.sources = sourcesOf(scene, window);
    this.sides = sidesOf(this.sources);
    this.wide = Float64Array.from(this.sides.flatMap(({ way, light }) => [...way.toArray(), ...light.toArray()]));
    this.spots = LAMP_SPOTS.map((spot) => spot.clone().add(this.sources.lamp));
    this.down = this.sources.middle.clone().sub(this.sources.lamp).normalize();
    this.day = this.sources.day.clone().sub(this.sources.middle.clone().setZ(0.9)).normalize();
  }

  /**
   * Light that falls on a small piece of a surface.
   * @param isShaded Whether what stands between it and the lamp counts.
   * @param out Red, green and blue from the lights, then from all surroundings.
   */
  at(place: Vector3, outwards: Vector3, isShaded: boolean, out: Float32Array): void {
    const { way } = this;
    const open = this.open(place.x + outwards.x * 0.11, place.y + outwards.y * 0.11, place.z + outwards.z * 0.11);
    const direct = (1 + (open - 1) * DIRECT_SHARE) / Math.PI;
    let lamp = this.lamp(place, way);
    if (lamp > 0) lamp *= Math.max(0, outwards.dot(way));
    if (lamp > 0 && isShaded) lamp *= this.lit(place, outwards);
    const day = DAY.strength * Math.max(0, outwards.dot(this.day));
    // What faces away from the window gets none of its glow.
    const facing = outwards.dot(way.copy(this.sources.glow).sub(place));
    const glow = facing > 0 ? this.glow(place, way) * Math.max(0, outwards.dot(way)) : 0;
    out[0] = direct * (lamp * LAMP.colour.r + day * DAY.colour.r + glow * GLOW.colour.r);
    out[1] = direct * (lamp * LAMP.colour.g + day * DAY.colour.g + glow * GLOW.colour.g);
    out[2] = direct * (lamp * LAMP.colour.b + day * DAY.colour.b + glow * GLOW.colour.b);
    let red = 0, green = 0, blue = 0;
    const { wide } = this;
    const { x, y, z } = outwards;
    for (let i = 0; i < wide.length; i += 6) {
      const share = 0.5 + 0.5 * (x * (wide[i] as number) + y * (wide[i + 1] as number) + z * (wide[i + 2] as number));
      red += share * (wide[i + 3] as number);
      green += share * (wide[i + 4] as number);
      blue += share * (wide[i + 5] as number);
    }
    out[3] = (red * open) / Math.PI;
    out[4] = (green * open) / Math.PI;
    out[5] = (blue * open) / Math.PI;
  }

  /** Light on a body that stands somewhere. */
  around(x: number, y: number, [lamps, sky]: readonly [lamps: number, sky: number]): BodyLight {
    return new BodyLight(
      this.sides.map(({ way, light }) => ({ way, light: light.clone().multiplyScalar(sky / Math.PI) })),
      this.raysAt(new Vector3(x, y, 1.2), lamps / Math.PI),
      (height) => this.open(x, y, height),
    );
  }

  /** Single lights as they come to a place, by a factor. */
  private raysAt(place: Vector3, factor: number): readonly Ray[] {
    const [toLamp, toGlow] = [new Vector3(), new Vector3()];
    const lamp = this.lamp(place, toLamp);
    const glow = this.glow(place, toGlow);
    return [
      { way: toLamp, light: asVector(LAMP.colour, lamp * factor) },
      { way: toGlow, light: asVector(GLOW.colour, glow * factor) },
      { way: this.day, light: asVector(DAY.colour, DAY.strength * factor) },
    ];
  }

  private open(x: number, y: number, z: number): number {
    return openShare(this.ambience.at(x, y, z));
  }

  /** How strong the lamp is at a place, and the way to it. */
  private lamp(place: Vector3, way: Vector3): number {
    way.copy(this.sources.lamp).sub(place).normalize();
    return LAMP.strength * smooth(OUTER, INNER, -way.dot(this.down));
  }

  /** How strong the glow of the window is at a place, and the way to it. */
  private glow(place: Vector3, way: Vector3): number {
    way.copy(this.sources.glow).sub(place);
    const far = way.length();
    way.divideScalar(far || 1);
    return (GLOW.strength * Math.max(0, 1 - (far / GLOW.reach) ** 4) ** 2) / Math.max(far ** GLOW.decay, 0.01);
  }

  /** How much of the lamp is seen from a place. */
  private lit(place: Vector3, outwards: Vector3): number {
    let lit = 0;
    for (const spot of this.spots) if (this.reaches(place, outwards, spot)) lit += 1 / LAMP_SPOTS.length;
    return lit;
  }

  /** Whether nothing is between a surface and a place; what the surface is itself in does not count. */
  private reaches(from: Vector3, outwards: Vector3, to: Vector3): boolean {
    const { filled, nx, ny, nz, box, top } = this.voxels;
    const { min } = box;
    // All in cells from here on.
    let x = (from.x + outwards.x * 0.06 - min.x) / CELL_M;
    let y = (from.y + outwards.y * 0.06 - min.y) / CELL_M;
    let z = (from.z + outwards.z * 0.06 - min.z) / CELL_M;
    const dx = (to.x - min.x) / CELL_M - x;
    const dy = (to.y - min.y) / CELL_M - y;
    const dz = (to.z - min.z) / CELL_M - z;
    const far = Math.sqrt(dx * dx + dy * dy + dz * dz);
    // The lamp hangs in its own shade, which lets light through.
    const near = far - LAMP_OWN_M / CELL_M;
    const end = dz > 0 ? Math.min(near, (((top - min.z) / CELL_M - z) * far) / dz) : near;
    let isOutside = false;
    for (let s = 0; s < end; s++) {
      if (x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz) {
        if (filled[(x | 0) + nx * ((y | 0) + ny * (z | 0))] === 0) isOutside = true;
        else if (isOutside) return false;
      }
      x += dx / far;
      y += dy / far;
      z += dz / far;
    }
    return true;
  }
}

const asVector = ({ r, g, b }: Color, strength: number): Vector3 => new Vector3(r, g, b).multiplyScalar(strength);
