// Light on a body where it stands: quickly told for each piece of its surface, from the way that it faces.

import type { Vector3 } from "three";
import { DIRECT_SHARE } from "./ambience.ts";
import { coded } from "./coding.ts";

/** Light that comes from somewhere. */
export interface Ray {
  way: Vector3;
  light: Vector3;
}

/** How open the surroundings are is known at heights so far apart, from the floor. */
const HEIGHT_M = 0.2;
const HEIGHTS = 12;

export class BodyLight {
  /** Of red, green and blue in turn: what comes from everywhere, and what is added for each way. */
  private readonly sky = new Float32Array(12);
  /** The way to each single light, and its colour. */
  private readonly rays: Float32Array;
  private readonly open: Float32Array;

  /**
   * @param sides Wide light: what faces away from it gets none, what faces aside half.
   * @param rays Single lights.
   * @param open How bright the surroundings are at a height, as a share.
   */
  constructor(sides: readonly Ray[], rays: readonly Ray[], open: (height: number) => number) {
    for (const { way, light } of sides) {
      [1, way.x, way.y, way.z].forEach((share, n) => {
        for (let k = 0; k < 3; k++) this.sky[k * 4 + n] = (this.sky[k * 4 + n] as number) + 0.5 * share * light.getComponent(k);
      });
    }
    this.rays = Float32Array.from(rays.flatMap(({ way, light }) => [...way.toArray(), ...light.toArray()]));
    this.open = Float32Array.from({ length: HEIGHTS }, (_, i) => open((i + 0.5) * HEIGHT_M));
  }

  /** Write the light of a corner that faces some way, at a height, with the colour of the surface. */
  put(nx: number, ny: number, nz: number, height: number, tint: readonly number[], out: { [at: number]: number }, at: number): void {
    const { sky, rays } = this;
    const open = this.open[Math.min(HEIGHTS - 1, Math.max(0, Math.floor(height / HEIGHT_M)))] as number;
    const direct = 1 + (open - 1) * DIRECT_SHARE;
    let red = 0, green = 0, blue = 0;
    for (let n = 0; n < rays.length; n += 6) {
      const facing = nx * (rays[n] as number) + ny * (rays[n + 1] as number) + nz * (rays[n + 2] as number);
      if (facing <= 0) continue;
      red += facing * (rays[n + 3] as number);
      green += facing * (rays[n + 4] as number);
      blue += facing * (rays[n + 5] as number);
    }
    const wide = (k: number): number => open * ((sky[k] as number) + nx * (sky[k + 1] as number) + ny * (sky[k + 2] as number) + nz * (sky[k + 3] as number));
    out[at] = coded((tint[0] as number) * (red * direct + wide(0)));
    out[at + 1] = coded((tint[1] as number) * (green * direct + wide(4)));
    out[at + 2] = coded((tint[2] as number) * (blue * direct + wide(8)));
  }
}
