// Marks in the room: how far she reaches, where she can walk, and what is pointed at.

import {
  Box3,
  Box3Helper,
  Color,
  DataTexture,
  DoubleSide,
  Group,
  LinearFilter,
  Mesh,
  MeshBasicMaterial,
  type Object3D,
  PlaneGeometry,
  RingGeometry,
  Vector3,
} from "three";
import type { BodyShape, SceneShape } from "../protocol.ts";
import type { Moment } from "../track/track.ts";
import type { Voxels } from "./voxels.ts";

const REACH = new Color(0xffa05c);
const WALK = [64, 160, 120] as const;

export class Marks {
  readonly group = new Group();
  private readonly reach: Mesh;
  private walkable: Mesh | null = null;
  private readonly box = new Box3Helper(new Box3(), new Color(0xff8a4c));

  constructor(
    private readonly scene: SceneShape,
    private readonly body: BodyShape,
    private readonly voxels: Voxels,
  ) {
    const ring = new RingGeometry(body.reach_m - 0.03, body.reach_m, 64);
    const look = { color: REACH, transparent: true, opacity: 0.85, side: DoubleSide, depthWrite: false, toneMapped: false };
    this.reach = new Mesh(ring, new MeshBasicMaterial(look));
    const disc = new Mesh(new RingGeometry(0.02, body.reach_m - 0.03, 64), new MeshBasicMaterial({ ...look, opacity: 0.16 }));
    const wall = this.reach.clone();
    wall.position.z = 0.8;
    this.reach.add(disc, wall);
    this.reach.renderOrder = 2;
    this.reach.visible = this.box.visible = false;
    this.group.add(this.reach, this.box);
  }

  showReach(on: boolean): void {
    this.reach.visible = on;
  }

  showWalkable(on: boolean): void {
    if (on && !this.walkable) {
      this.walkable = this.floorPlan();
      this.group.add(this.walkable);
    }
    if (this.walkable) this.walkable.visible = on;
  }

  private floorPlan(): Mesh {
    const { nx, ny } = this.voxels;
    const free = this.voxels.standing(this.body.radius_m);
    const picture = new Uint8Array(nx * ny * 4);
    for (let i = 0; i < nx * ny; i++) picture.set([...WALK, free[i] ? 120 : 0], i * 4);
    const map = new DataTexture(picture, nx, ny);
    map.magFilter = LinearFilter;
    map.needsUpdate = true;
    const { x_min, x_max, y_min, y_max } = this.scene;
    const plane = new Mesh(
      new PlaneGeometry(x_max - x_min, y_max - y_min),
      new MeshBasicMaterial({ map, transparent: true, depthWrite: false, toneMapped: false }),
    );
    plane.position.set((x_min + x_max) / 2, (y_min + y_max) / 2, 0.012);
    plane.renderOrder = 1;
    return plane;
  }

  /** Draw a box around a thing; null for none. */
  outline(thing: Object3D | null): void {
    this.box.visible = thing !== null;
    if (thing) this.box.box.setFromObject(thing).expandByVector(new Vector3(0.012, 0.012, 0.012));
  }

  update(moment: Moment): void {
    this.reach.position.set(moment.body[0], moment.body[1], 0.015);
  }
}
