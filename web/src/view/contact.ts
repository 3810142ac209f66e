// Dark soft spots where feet and things touch what carries them: one draw call for all.

import { BufferAttribute, BufferGeometry, DataTexture, DynamicDrawUsage, LinearFilter, Mesh, Quaternion, Vector3 } from "three";
import type { Placed, SceneObject } from "../protocol.ts";
import type { Moment } from "../track/track.ts";
import type { Figure } from "./figure.ts";
import type { Plain } from "./plain.ts";

const TURN = new Quaternion();
const LIFT_M = 0.004;

const SPOT_PX = 32;

function spot(): DataTexture {
  const data = new Uint8Array(SPOT_PX * SPOT_PX * 4);
  for (let i = 0; i < SPOT_PX * SPOT_PX; i++) {
    const [x, y] = [(i % SPOT_PX) + 0.5, Math.floor(i / SPOT_PX) + 0.5];
    const far = Math.min(1, Math.hypot(x / SPOT_PX - 0.5, y / SPOT_PX - 0.5) * 2);
    data.set([255, 255, 255, Math.round(158 * (1 - far) ** 1.7)], i * 4);
  }
  const texture = new DataTexture(data, SPOT_PX, SPOT_PX);
  texture.magFilter = texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

const DARK = [0.012, 0.007, 0.003, 1] as const;
const CORNERS = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]] as const;

export class ContactShadows {
  readonly mesh: Mesh;
  /** Whether her own shadow is such a spot as well, where no other one is drawn. */
  isHers = true;
  private readonly places: BufferAttribute;
  private count = 0;
  /** Of each thing, where it was last, and half of the upright box around it there. */
  private readonly halves = new Map<number, { at: Placed; half: Vector3 }>();

  constructor(
    private readonly objects: readonly SceneObject[],
    plain: Plain,
  ) {
    const most = objects.length + 3;
    const geometry = new BufferGeometry();
    this.places = new BufferAttribute(new Float32Array(most * 12), 3).setUsage(DynamicDrawUsage);
    const each = (values: readonly number[]): Float32Array => Float32Array.from({ length: most * values.length }, (_, i) => values[i % values.length] ?? 0);
    geometry.setAttribute("position", this.places);
    geometry.setAttribute("uv", new BufferAttribute(each([0, 0, 1, 0, 1, 1, 0, 1]), 2));
    geometry.setAttribute("light", new BufferAttribute(each(DARK), 4));
    geometry.setIndex(Array.from({ length: most * 6 }, (_, i) => Math.floor(i / 6) * 4 + ([0, 1, 2, 0, 2, 3][i % 6] ?? 0)));
    const material = plain.veil(spot());
    material.polygonOffset = true;
    material.polygonOffsetFactor = material.polygonOffsetUnits = -2;
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 1;
  }

  update(moment: Moment, figure: Figure): void {
    this.count = 0;
    for (const { id, size } of this.objects) {
      const at = moment.things.get(id);
      if (!at || moment.held === id || moment.gone.has(id)) continue;
      const half = this.half(id, size, at);
      this.put(at[0], at[1], at[2] - half.z, half.x * 3.1 + 0.015, half.y * 3.1 + 0.015);
    }
    const [x, y, heading] = moment.body;
    for (const foot of figure.footPlaces()) if (foot.z < 0.2) this.put(foot.x, foot.y, 0, 0.46, 0.26, heading);
    if (this.isHers) this.put(x, y, 0, 0.95, 1.15, heading);
    this.mesh.geometry.setDrawRange(0, this.count * 6);
    this.places.needsUpdate = true;
  }

  private half(id: number, size: SceneObject["size"], at: Placed): Vector3 {
    const known = this.halves.get(id);
    if (known?.at === at) return known.half;
    const half = halfExtents(size, TURN.set(at[3], at[4], at[5], at[6]));
    this.halves.set(id, { at, half });
    return half;
  }

  private put(x: number, y: number, z: number, width: number, depth: number, heading = 0): void {
    const [cos, sin] = [Math.cos(heading), Math.sin(heading)];
    let corner = this.count * 4;
    for (const [u, v] of CORNERS) {
      const along = u * width;
      const aside = v * depth;
      this.places.setXYZ(corner++, x + along * cos - aside * sin, y + along * sin + aside * cos, z + LIFT_M);
    }
    this.count++;
  }
}

/** Half of the upright box around a turned box. */
export function halfExtents(size: readonly [number, number, number], turn: Quaternion): Vector3 {
  const out = new Vector3();
  for (let axis = 0; axis < 3; axis++) {
    const edge = new Vector3().setComponent(axis, (size[axis] ?? 0) / 2).applyQuaternion(turn);
    out.x += Math.abs(edge.x);
    out.y += Math.abs(edge.y);
    out.z += Math.abs(edge.z);
  }
  return out;
}
