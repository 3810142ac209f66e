// The plain look for a room that is edited: light at the corners of triangles, worked out anew when something stands elsewhere.

import { Box3, type Material, type Mesh, type Object3D, Vector3 } from "three";
import { Ambience } from "../view/ambience.ts";
import { Brightness, type Extent } from "../view/brightness.ts";
import { isStandard, meshesIn } from "../view/loading.ts";
import { Plain } from "../view/plain.ts";
import { isFlat, sharing } from "../view/room.ts";
import { surface } from "../view/surfaces.ts";
import { Voxels } from "../view/voxels.ts";

/** So long nothing is moved any more before the light is worked out; milliseconds. */
const CALM_MS = 250;

/** What light falls on: furniture throws shade, walls and furniture get it, objects do neither. */
export interface Standing {
  node: Object3D;
  kind: "walls" | "furniture" | "object";
}

export class Plainly {
  private readonly plain: Plain;
  /** What each mesh is made of in its file. */
  private readonly own = new Map<Mesh, Material>();
  private waiting: ReturnType<typeof setTimeout> | undefined;

  /**
   * @param room How far it reaches.
   * @param standing All that is in it now.
   * @param relit Called when the light is another one.
   */
  constructor(
    private readonly room: Extent,
    private readonly standing: () => readonly Standing[],
    private readonly relit: () => void,
  ) {
    this.plain = new Plain(this.brightness([]));
  }

  private brightness(shading: readonly Mesh[]): Brightness {
    const { x_min, x_max, y_min, y_max, height_m } = this.room;
    const voxels = new Voxels(new Box3(new Vector3(x_min, y_min, 0), new Vector3(x_max, y_max, height_m)));
    for (const mesh of shading) if (!isFlat(mesh)) voxels.add(mesh);
    return new Brightness(this.room, null, voxels, new Ambience(voxels));
  }

  /** Give something new its look, under a first light. */
  dress(node: Object3D): void {
    node.updateMatrixWorld(true);
    for (const mesh of meshesIn(node)) {
      const own = surface(mesh.material as Material);
      if (!isStandard(own)) continue;
      // Two of a kind share their shape, but not their light.
      mesh.geometry = sharing(mesh.geometry);
      mesh.material = this.plain.look(own);
      this.own.set(mesh, own);
      this.plain.light(mesh.geometry, own, mesh.matrixWorld, false);
    }
  }

  /** Work out the light as soon as nothing is moved any more. */
  soon(): void {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.relight(), CALM_MS);
  }

  /** Work out all light for what stands where now. */
  relight(): void {
    const all = this.standing().flatMap(({ node, kind }) => {
      node.updateMatrixWorld(true);
      return meshesIn(node).map((mesh) => ({ mesh, kind, own: this.own.get(mesh) }));
    });
    this.plain.brightness = this.brightness(all.filter(({ kind }) => kind === "furniture").map(({ mesh }) => mesh));
    const gone = new Set(this.own.keys());
    for (const { mesh, kind, own } of all) {
      if (own) this.plain.light(mesh.geometry, own, mesh.matrixWorld, kind !== "object");
      gone.delete(mesh);
    }
    for (const mesh of gone) {
      this.own.delete(mesh);
      this.plain.forget(mesh.geometry);
    }
    this.relit();
  }

  /** Change the brightness: 1 is a lit room, 0 a dark one. */
  dim(share: number): void {
    this.plain.dim(share);
  }

  close(): void {
    clearTimeout(this.waiting);
    this.plain.close();
  }
}
