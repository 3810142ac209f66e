// Dark soft spots where feet and things touch what carries them: one draw call for all.

import {
  DataTexture,
  DynamicDrawUsage,
  InstancedMesh,
  LinearFilter,
  Matrix4,
  MeshBasicMaterial,
  PlaneGeometry,
  Quaternion,
  Vector3,
} from "three";
import type { SceneObject } from "../protocol.ts";
import type { Moment } from "../track/track.ts";
import type { Figure } from "./figure.ts";

const FLAT = new Quaternion();
const LIFT_M = 0.004;

const SPOT_PX = 32;

function spot(): DataTexture {
  const data = new Uint8Array(SPOT_PX * SPOT_PX * 4);
  for (let i = 0; i < SPOT_PX * SPOT_PX; i++) {
    const [x, y] = [(i % SPOT_PX) + 0.5, Math.floor(i / SPOT_PX) + 0.5];
    const far = Math.min(1, Math.hypot(x / SPOT_PX - 0.5, y / SPOT_PX - 0.5) * 2);
    data.set([20, 12, 6, Math.round(158 * (1 - far) ** 1.7)], i * 4);
  }
  const texture = new DataTexture(data, SPOT_PX, SPOT_PX);
  texture.magFilter = texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

export class ContactShadows {
  readonly mesh: InstancedMesh;

  constructor(private readonly objects: readonly SceneObject[]) {
    const material = new MeshBasicMaterial({
      map: spot(),
      transparent: true,
      depthWrite: false,
      toneMapped: false,
      polygonOffset: true,
      polygonOffsetFactor: -2,
      polygonOffsetUnits: -2,
    });
    this.mesh = new InstancedMesh(new PlaneGeometry(1, 1), material, objects.length + 2);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 1;
  }

  update(moment: Moment, figure: Figure): void {
    let count = 0;
    const put = (x: number, y: number, z: number, width: number, depth: number, turn: Quaternion): void => {
      const matrix = new Matrix4().compose(new Vector3(x, y, z + LIFT_M), turn, new Vector3(width, depth, 1));
      this.mesh.setMatrixAt(count++, matrix);
    };
    for (const { id, size } of this.objects) {
      const at = moment.things.get(id);
      if (!at || moment.held === id || moment.gone.has(id)) continue;
      const turn = new Quaternion(at[3], at[4], at[5], at[6]);
      const half = halfExtents(size, turn);
      put(at[0], at[1], at[2] - half.z, half.x * 3.1 + 0.015, half.y * 3.1 + 0.015, FLAT);
    }
    const heading = new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), moment.body[2]);
    for (const foot of figure.footPlaces()) if (foot.z < 0.2) put(foot.x, foot.y, 0, 0.46, 0.26, heading);
    this.mesh.count = count;
    this.mesh.instanceMatrix.needsUpdate = true;
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
