// Her body for the plain look: shaped, turned and lit here once a picture. A processor that draws would do
// it for the corners of every triangle, which takes several times as long.

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh, type MeshStandardMaterial, type Material, type SkinnedMesh } from "three";
import type { BodyLight } from "./bodylight.ts";
import { coded } from "./coding.ts";
import { floats } from "./floats.ts";
import type { Plain } from "./plain.ts";
import { surface } from "./surfaces.ts";

/** What one shape of a face moves: corners, and how far. */
interface Shape {
  corners: Uint32Array;
  by: Float32Array;
}

/** An attribute of all meshes, one after the other, as plain numbers. */
function numbers(meshes: readonly SkinnedMesh[], name: string, size: number): Float32Array {
  const own = meshes.map(({ geometry }) => geometry.getAttribute(name));
  const out = new Float32Array(own.reduce((sum, { count }) => sum + count * size, 0));
  let at = 0;
  for (const attribute of own) {
    floats(attribute, out, at);
    at += attribute.count * size;
  }
  return out;
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

/** One of the meshes that the body consists of. */
interface Part {
  mesh: SkinnedMesh;
  /** Its corners among those of the whole body. */
  from: number;
  to: number;
  /** Those of them that one joint alone carries, by joint, which is quickly told; and all others. */
  stiff: ReadonlyMap<number, readonly number[]>;
  soft: readonly number[];
  shapes: readonly Shape[];
  /** Shares of the shapes that are taken on. */
  mixed: Float32Array;
  /** Roots of the colour of its surface, as they are kept for a corner. */
  tint: readonly number[];
}

/** Which joints carry each corner, as places in the list of their matrices, and how much. */
interface Carried {
  /** Of each corner, where its joints begin; of the next one, where they end. */
  begin: Uint32Array;
  joint: Uint32Array;
  weight: Float32Array;
}

function carriedOf(meshes: readonly SkinnedMesh[]): Carried {
  const joints = numbers(meshes, "skinIndex", 4);
  const shares = numbers(meshes, "skinWeight", 4);
  const begin = new Uint32Array(shares.length / 4 + 1);
  const joint = new Uint32Array(shares.length);
  const weight = new Float32Array(shares.length);
  let count = 0;
  for (let i = 0; i < shares.length; i++) {
    const share = shares[i] as number;
    if (share !== 0) {
      joint[count] = (joints[i] as number) * 16;
      weight[count++] = share;
    }
    if (i % 4 === 3) begin[(i + 1) / 4] = count;
  }
  return { begin, joint, weight };
}

/** The corners from one to another that go along with one joint alone, by joint, and all others. */
function parted({ begin, joint, weight }: Carried, from: number, to: number): { stiff: Map<number, number[]>; soft: number[] } {
  const stiff = new Map<number, number[]>();
  const soft: number[] = [];
  for (let corner = from; corner < to; corner++) {
    const first = begin[corner] as number;
    const isAlone = begin[corner + 1] === first + 1 && weight[first] === 1;
    const own = joint[first] as number;
    const alike = isAlone ? (stiff.get(own) ?? []) : soft;
    if (isAlone) stiff.set(own, alike);
    alike.push(corner);
  }
  return { stiff, soft };
}

export class Skin {
  /** All of the body: one shape, with a group for each material. */
  readonly shown: Mesh<BufferGeometry, Material[]>;
  /** Whether the pose or the light is another one since it was shown last. */
  isStale = true;
  private readonly parts: readonly Part[];
  private readonly places: BufferAttribute;
  private readonly light: BufferAttribute;
  private readonly rest: Float32Array;
  private readonly shaped: Float32Array;
  private readonly normals: Float32Array;
  /** The normals in this pose. */
  private readonly ways: Float32Array;
  private readonly carried: Carried;

  constructor(meshes: readonly SkinnedMesh[], plain: Plain) {
    this.rest = numbers(meshes, "position", 3);
    this.shaped = this.rest.slice();
    this.normals = numbers(meshes, "normal", 3);
    this.ways = this.normals.slice();
    this.carried = carriedOf(meshes);
    const count = this.rest.length / 3;
    this.places = new BufferAttribute(new Float32Array(count * 3), 3).setUsage(DynamicDrawUsage);
    this.light = new BufferAttribute(new Uint8ClampedArray(count * 4).fill(255), 4, true).setUsage(DynamicDrawUsage);
    const shape = new BufferGeometry();
    shape.setAttribute("position", this.places);
    shape.setAttribute("light", this.light);
    shape.setAttribute("uv", new BufferAttribute(numbers(meshes, "uv", 2), 2));
    const corners: number[] = [];
    const looks: Material[] = [];
    let from = 0;
    this.parts = meshes.map((mesh) => {
      const own = surface(mesh.material as Material) as MeshStandardMaterial;
      const { array } = mesh.geometry.getIndex() as BufferAttribute;
      shape.addGroup(corners.length, array.length, looks.length);
      looks.push(plain.look(own));
      for (const corner of array) corners.push(from + corner);
      const to = from + mesh.geometry.getAttribute("position").count;
      const shapes = shapesOf(mesh.geometry);
      const tint = "color" in own ? own.color.toArray() : [1, 1, 1];
      const part = { mesh, from, to, ...parted(this.carried, from, to), shapes, mixed: new Float32Array(shapes.length), tint: tint.map(coded) };
      from = to;
      return part;
    });
    shape.setIndex(corners);
    this.shown = new Mesh(shape, looks);
    this.shown.frustumCulled = false;
    // She stands before most of the room: what she hides need not be drawn.
    this.shown.renderOrder = -1;
  }

  /** Take on the pose of the skeleton and the shapes of the face, under this light. */
  update(light: BodyLight): void {
    let isOther = false;
    for (const part of this.parts) {
      if (!(this.shape(part) || this.isStale)) continue;
      this.bend(part);
      light.shade(this.places.array, this.ways, part.from, part.to, part.tint, this.light.array);
      isOther = true;
    }
    this.isStale = false;
    if (isOther) this.places.needsUpdate = this.light.needsUpdate = true;
  }

  private bend({ mesh, stiff, soft }: Part): void {
    const bones = mesh.skeleton.boneMatrices;
    if (!bones) return;
    for (const [joint, corners] of stiff) this.carry(corners, bones, joint);
    this.blend(soft, bones);
  }

  /** Take corners to where one joint has them. */
  private carry(corners: readonly number[], bones: Float32Array, m: number): void {
    const { shaped, normals, ways } = this;
    const places = this.places.array;
    const xx = bones[m] as number, xy = bones[m + 4] as number, xz = bones[m + 8] as number, x0 = bones[m + 12] as number;
    const yx = bones[m + 1] as number, yy = bones[m + 5] as number, yz = bones[m + 9] as number, y0 = bones[m + 13] as number;
    const zx = bones[m + 2] as number, zy = bones[m + 6] as number, zz = bones[m + 10] as number, z0 = bones[m + 14] as number;
    for (let i = 0; i < corners.length; i++) {
      const at = (corners[i] as number) * 3;
      const x = shaped[at] as number;
      const y = shaped[at + 1] as number;
      const z = shaped[at + 2] as number;
      const a = normals[at] as number;
      const b = normals[at + 1] as number;
      const c = normals[at + 2] as number;
      places[at] = xx * x + xy * y + xz * z + x0;
      places[at + 1] = yx * x + yy * y + yz * z + y0;
      places[at + 2] = zx * x + zy * y + zz * z + z0;
      ways[at] = xx * a + xy * b + xz * c;
      ways[at + 1] = yx * a + yy * b + yz * c;
      ways[at + 2] = zx * a + zy * b + zz * c;
    }
  }

  /** Take corners to where several joints have them, each to its share. */
  private blend(corners: readonly number[], bones: Float32Array): void {
    const { shaped, normals, ways } = this;
    const { begin, joint, weight } = this.carried;
    const places = this.places.array;
    for (let i = 0; i < corners.length; i++) {
      const corner = corners[i] as number;
      const at = corner * 3;
      const x = shaped[at] as number;
      const y = shaped[at + 1] as number;
      const z = shaped[at + 2] as number;
      const a = normals[at] as number;
      const b = normals[at + 1] as number;
      const c = normals[at + 2] as number;
      const end = begin[corner + 1] as number;
      let px = 0, py = 0, pz = 0, nx = 0, ny = 0, nz = 0;
      for (let n = begin[corner] as number; n < end; n++) {
        const share = weight[n] as number;
        const m = joint[n] as number;
        const xx = bones[m] as number, xy = bones[m + 4] as number, xz = bones[m + 8] as number;
        const yx = bones[m + 1] as number, yy = bones[m + 5] as number, yz = bones[m + 9] as number;
        const zx = bones[m + 2] as number, zy = bones[m + 6] as number, zz = bones[m + 10] as number;
        px += share * (xx * x + xy * y + xz * z + (bones[m + 12] as number));
        py += share * (yx * x + yy * y + yz * z + (bones[m + 13] as number));
        pz += share * (zx * x + zy * y + zz * z + (bones[m + 14] as number));
        nx += share * (xx * a + xy * b + xz * c);
        ny += share * (yx * a + yy * b + yz * c);
        nz += share * (zx * a + zy * b + zz * c);
      }
      places[at] = px;
      places[at + 1] = py;
      places[at + 2] = pz;
      ways[at] = nx;
      ways[at + 1] = ny;
      ways[at + 2] = nz;
    }
  }

  /** Take on the shapes of the face; returns whether they are others. */
  private shape({ mesh, from, to, shapes, mixed }: Part): boolean {
    const wished = mesh.morphTargetInfluences ?? [];
    if (mixed.every((share, i) => share === Math.fround(wished[i] ?? 0))) return false;
    mixed.set(wished);
    this.shaped.set(this.rest.subarray(from * 3, to * 3), from * 3);
    shapes.forEach(({ corners, by }, i) => {
      const share = mixed[i] ?? 0;
      if (share === 0) return;
      corners.forEach((corner, n) => {
        for (let k = 0; k < 3; k++) {
          const at = (from + corner) * 3 + k;
          this.shaped[at] = (this.shaped[at] as number) + share * (by[n * 3 + k] as number);
        }
      });
    });
    return true;
  }
}
