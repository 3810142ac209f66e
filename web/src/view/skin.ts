// Her body for the plain look: shaped, turned and lit here once a picture. A processor that draws would do
// it for the corners of every triangle, which takes several times as long.

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh, type MeshStandardMaterial, type Material, type SkinnedMesh } from "three";
import type { BodyLight } from "./bodylight.ts";
import type { Plain } from "./plain.ts";
import { surface } from "./surfaces.ts";

/** What one shape of a face moves: corners, and how far. */
interface Shape {
  corners: Uint32Array;
  by: Float32Array;
}

/** An attribute as plain numbers. */
function numbers(geometry: BufferGeometry, name: string, size: number): Float32Array {
  const own = geometry.getAttribute(name);
  return Float32Array.from({ length: own.count * size }, (_, i) => own.getComponent(Math.floor(i / size), i % size));
}

function shapesOf(geometry: BufferGeometry): Shape[] {
  return (geometry.morphAttributes.position ?? []).map((shape) => {
    const corners: number[] = [];
    const by: number[] = [];
    for (let i = 0; i < shape.count; i++) {
      const way = [shape.getX(i), shape.getY(i), shape.getZ(i)];
      if (!way.some((value) => value !== 0)) continue;
      corners.push(i);
      by.push(...way);
    }
    return { corners: Uint32Array.from(corners), by: Float32Array.from(by) };
  });
}

export class Skin {
  readonly shown: Mesh;
  /** Whether the pose or the light is another one since it was shown last. */
  isStale = true;
  private readonly places: BufferAttribute;
  private readonly light: BufferAttribute;
  private readonly rest: Float32Array;
  private readonly shaped: Float32Array;
  private readonly normals: Float32Array;
  private readonly joints: Float32Array;
  private readonly weights: Float32Array;
  private readonly shapes: Shape[];
  private readonly mixed: Float32Array;
  private readonly tint: readonly number[];

  constructor(
    private readonly mesh: SkinnedMesh,
    plain: Plain,
  ) {
    const { geometry } = mesh;
    const own = surface(mesh.material as Material) as MeshStandardMaterial;
    this.rest = numbers(geometry, "position", 3);
    this.shaped = this.rest.slice();
    this.normals = numbers(geometry, "normal", 3);
    this.joints = numbers(geometry, "skinIndex", 4);
    this.weights = numbers(geometry, "skinWeight", 4);
    this.shapes = shapesOf(geometry);
    this.mixed = new Float32Array(this.shapes.length);
    this.tint = "color" in own ? own.color.toArray() : [1, 1, 1];
    const count = this.rest.length / 3;
    this.places = new BufferAttribute(new Float32Array(count * 3), 3).setUsage(DynamicDrawUsage);
    this.light = new BufferAttribute(new Uint8ClampedArray(count * 4).fill(255), 4, true).setUsage(DynamicDrawUsage);
    const shown = new BufferGeometry();
    shown.setAttribute("position", this.places);
    shown.setAttribute("light", this.light);
    shown.setAttribute("uv", geometry.getAttribute("uv"));
    shown.setIndex(geometry.getIndex());
    this.shown = new Mesh(shown, plain.look(own));
    this.shown.frustumCulled = false;
    // She stands before most of the room: what she hides need not be drawn.
    this.shown.renderOrder = -1;
  }

  /** Take on the pose of the skeleton and the shapes of the face, under this light. */
  update(light: BodyLight): void {
    if (!this.shape() && !this.isStale) return;
    this.isStale = false;
    const bones = this.mesh.skeleton.boneMatrices;
    if (!bones) return;
    const { shaped, normals, joints, weights, tint } = this;
    const places = this.places.array;
    const out = this.light.array;
    const bone = (at: number): number => bones[at] as number;
    let [corner, at] = [0, 0];
    for (; at < shaped.length; corner += 4, at += 3) {
      const x = shaped[at] as number;
      const y = shaped[at + 1] as number;
      const z = shaped[at + 2] as number;
      const a = normals[at] as number;
      const b = normals[at + 1] as number;
      const c = normals[at + 2] as number;
      let px = 0, py = 0, pz = 0, nx = 0, ny = 0, nz = 0;
      for (let n = corner; n < corner + 4; n++) {
        const weight = weights[n] as number;
        if (weight === 0) continue;
        const m = (joints[n] as number) * 16;
        const xx = bone(m) * weight, xy = bone(m + 4) * weight, xz = bone(m + 8) * weight;
        const yx = bone(m + 1) * weight, yy = bone(m + 5) * weight, yz = bone(m + 9) * weight;
        const zx = bone(m + 2) * weight, zy = bone(m + 6) * weight, zz = bone(m + 10) * weight;
        px += xx * x + xy * y + xz * z + bone(m + 12) * weight;
        py += yx * x + yy * y + yz * z + bone(m + 13) * weight;
        pz += zx * x + zy * y + zz * z + bone(m + 14) * weight;
        nx += xx * a + xy * b + xz * c;
        ny += yx * a + yy * b + yz * c;
        nz += zx * a + zy * b + zz * c;
      }
      places[at] = px;
      places[at + 1] = py;
      places[at + 2] = pz;
      light.put(nx, ny, nz, pz, tint, out, corner);
    }
    this.places.needsUpdate = this.light.needsUpdate = true;
  }

  /** Take on the shapes of the face; returns whether they are others. */
  private shape(): boolean {
    const wished = this.mesh.morphTargetInfluences ?? [];
    if (this.mixed.every((share, i) => share === Math.fround(wished[i] ?? 0))) return false;
    this.mixed.set(wished);
    this.shaped.set(this.rest);
    this.shapes.forEach(({ corners, by }, i) => {
      const share = this.mixed[i] ?? 0;
      if (share === 0) return;
      corners.forEach((corner, n) => {
        for (let k = 0; k < 3; k++) {
          const at = corner * 3 + k;
          this.shaped[at] = (this.shaped[at] as number) + share * (by[n * 3 + k] as number);
        }
      });
    });
    return true;
  }
}
