// Light on a body where it stands: quickly told for each piece of its surface, from the way that it faces.

import type { Vector3 } from "three";
import { DIRECT_SHARE } from "./ambience.ts";

/** Light that comes from somewhere. */
export interface Ray {
  way: Vector3;
  light: Vector3;
}

type Numbers = { [at: number]: number };
/** So many numbers; for reading lists whose length is known. */
type Eighteen = readonly [number, number, number, number, number, number, number, number, number, number, number, number, number, number, number, number, number, number];

/** How open the surroundings are is known at heights so far apart, from the floor. */
const HEIGHT_M = 0.2;
const HEIGHTS = 12;
/** So many single lights there are at most. */
const MOST_RAYS = 3;

export class BodyLight {
  /** Of red, green and blue in turn: what comes from everywhere, and what is added for each way. */
  private readonly sky = new Float32Array(12);
  /** The way to each single light, and its colour. */
  private readonly rays = new Float32Array(MOST_RAYS * 6);
  private readonly open: Float32Array;

  /**
   * @param sides Wide light: what faces away from it gets none, what faces aside half.
   * @param rays Single lights, three at most.
   * @param open How bright the surroundings are at a height, as a share.
   */
  constructor(sides: readonly Ray[], rays: readonly Ray[], open: (height: number) => number) {
    for (const { way, light } of sides) {
      [1, way.x, way.y, way.z].forEach((share, n) => {
        for (let k = 0; k < 3; k++) this.sky[k * 4 + n] = (this.sky[k * 4 + n] as number) + 0.5 * share * light.getComponent(k);
      });
    }
    rays.slice(0, MOST_RAYS).forEach(({ way, light }, n) => this.rays.set([...way.toArray(), ...light.toArray()], n * 6));
    this.open = Float32Array.from({ length: HEIGHTS }, (_, i) => open((i + 0.5) * HEIGHT_M));
  }

  /**
   * Write the light of some corners. Every corner of her body asks in every picture: nothing is looked up twice.
   * @param places Where they are; their third number is the height.
   * @param ways Which way they face.
   * @param tint Roots of the colour of the surface (`coded`).
   * @param out Four bytes for each corner; the last is left as it is.
   */
  shade(places: Numbers, ways: Numbers, from: number, to: number, tint: readonly number[], out: Numbers): void {
    const { open } = this;
    const [ax, ay, az, ar, ag, ab, bx, by, bz, br, bg, bb, cx, cy, cz, cr, cg, cb] = this.rays as unknown as Eighteen;
    const [r0, rx, ry, rz, g0, gx, gy, gz, b0, bx0, by0, bz0] = this.sky as unknown as Eighteen;
    const [red, green, blue] = tint as Eighteen;
    for (let corner = from, at = from * 3; corner < to; corner++, at += 3) {
      const x = ways[at] as number;
      const y = ways[at + 1] as number;
      const z = ways[at + 2] as number;
      const height = (places[at + 2] as number) / HEIGHT_M;
      const wide = open[Math.min(HEIGHTS - 1, Math.max(0, height | 0))] as number;
      const direct = 1 + (wide - 1) * DIRECT_SHARE;
      const a = direct * Math.max(0, x * ax + y * ay + z * az);
      const b = direct * Math.max(0, x * bx + y * by + z * bz);
      const c = direct * Math.max(0, x * cx + y * cy + z * cz);
      out[corner * 4] = red * Math.sqrt(a * ar + b * br + c * cr + wide * (r0 + x * rx + y * ry + z * rz));
      out[corner * 4 + 1] = green * Math.sqrt(a * ag + b * bg + c * cg + wide * (g0 + x * gx + y * gy + z * gz));
      out[corner * 4 + 2] = blue * Math.sqrt(a * ab + b * bb + c * cb + wide * (b0 + x * bx0 + y * by0 + z * bz0));
    }
  }
}
