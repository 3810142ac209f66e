// What the pointer is on: a thing, or a place on the floor, on a surface or on a wall.

import { type Mesh, type Object3D, Raycaster, Vector2, Vector3 } from "three";
import type { Stage } from "./stage.ts";

export interface Hit {
  objectId: number | null;
  point: Vector3;
  /** Outwards from the surface. */
  normal: Vector3;
}

/** From a pointer event to -1..1 across the canvas. */
export function across(canvas: HTMLElement, event: { clientX: number; clientY: number }): Vector2 {
  const area = canvas.getBoundingClientRect();
  const x = ((event.clientX - area.left) / area.width) * 2 - 1;
  return new Vector2(x, 1 - ((event.clientY - area.top) / area.height) * 2);
}

export class Pointing {
  private readonly ray = new Raycaster();

  constructor(private readonly stage: Stage) {}

  /** The first thing or surface under the pointer; `without` is looked through. */
  at(event: { clientX: number; clientY: number }, without: number | null = null): Hit | null {
    const { stage } = this;
    this.ray.setFromCamera(across(stage.renderer.domElement, event), stage.cameras.camera);
    const things = [...stage.room.things].filter(([id, thing]) => id !== without && thing.visible).map(([, thing]) => thing);
    const targets: Object3D[] = [...stage.room.fixed, ...things];
    const hit = this.ray.intersectObjects<Mesh>(targets, true)[0];
    if (!hit) return null;
    const normal = (hit.face?.normal.clone() ?? new Vector3(0, 0, 1)).transformDirection(hit.object.matrixWorld);
    const id = hit.object.userData.objectId as number | undefined;
    return { objectId: id ?? null, point: hit.point, normal };
  }
}
