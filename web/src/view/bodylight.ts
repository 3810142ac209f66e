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
  private readonly open = new Float32Array(HEIGHTS);

  /**
   * @param sides Wide light: what faces away from it gets none, what faces aside half.
   * @param rays Single lights, three at most.
   * @param open How bright the surroundings are at a height, as a share.
   */
  constructor(sides: readonly Ray[], rays: readonly Ray[], open: (height: number) => number) {
    for (const { way, light } of sides) {
      this.add(0, way, light.x);
      this.add(4, way, light.y);
      this.add(8, way, light.z);
    }
    for (let n = 0; n < Math.min(rays.length, MOST_RAYS); n++) {
      const { way, light } = rays[n] as Ray;
      way.toArray(this.rays, n * 6);
      light.toArray(this.rays, n * 6 + 3);
    }
    for (let i = 0; i < HEIGHTS; i++) this.open[i] = open((i + 0.5) * HEIGHT_M);
  }

  private add(at: number, { x, y, z }: Vector3, light: number): void {
    const { sky } = this;
    sky[at] = (sky[at] as number) + 0.5 * light;
    sky[at + 1] = (sky[at + 1] as number) + 0.5 * x * light;
    sky[at + 2] = (sky[at + 2] as number) + 0.5 * y * light;
    sky[at + 3] = (sky[at + 3] as number) + 0.5 * z * light;
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
    // One by one: to take lists apart in one go takes far longer to get ready for.
    const rays = this.rays as unknown as Eighteen;
    const ax = rays[0], ay = rays[1], az = rays[2], ar = rays[3], ag = rays[4], ab = rays[5];
    const bx = rays[6], by = rays[7], bz = rays[8], br = rays[9], bg = rays[10], bb = rays[11];
    const cx = rays[12], cy = rays[13], cz = rays[14], cr = rays[15], cg = rays[16], cb = rays[17];
    const sky = this.sky as unknown as Eighteen;
    const r0 = sky[0], rx = sky[1], ry = sky[2], rz = sky[3];
    const g0 = sky[4], gx = sky[5], gy = sky[6], gz = sky[7];
    const b0 = sky[8], bx0 = sky[9], by0 = sky[10], bz0 = sky[11];
    const red = tint[0] as number, green = tint[1] as number, blue = tint[2] as number;
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
