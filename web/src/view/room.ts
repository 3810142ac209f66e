// The room: walls, furniture and things, from one GLB. Frame: z up, metres, as the server has it.

import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import { Box3, BufferGeometry, Group, type Material, type Matrix4, type Mesh, type Object3D, Vector3 } from "three";
import type { Placed, SceneShape } from "../protocol.ts";
import { Ambience } from "./ambience.ts";
import { Brightness } from "./brightness.ts";
import { meshesIn, nodesByName } from "./loading.ts";
import { merged } from "./merging.ts";
import { Plain } from "./plain.ts";
import { split } from "./splitting.ts";
import { fullLook, SHADES, surface } from "./surfaces.ts";
import { Voxels } from "./voxels.ts";

/** The longest edge where shades are to be seen within a surface. */
export const FINE_M = 0.2;
/** What is moved further than this, metres, or turned so, is lit anew. */
const LIT_AGAIN = 0.1;
const SHELL = ["walls", "ceiling", "parquet", "outside"];

/** What a mesh is made of in the file, and how that is drawn. */
interface Looks {
  mesh: Mesh;
  own: Material;
  plain: Material;
  full: Material;
}

export class Room {
  readonly group = new Group();
  readonly things = new Map<number, Object3D>();
  readonly voxels: Voxels;
  readonly ambience: Ambience;
  readonly window: Vector3 | null;
  /** What the pointer can meet that does not move. */
  readonly fixed: Mesh[];
  readonly plain: Plain;
  private readonly looks: Looks[];
  /** Where things were when their light was worked out. */
  private readonly lit = new Map<Object3D, Matrix4>();
  /** Where things were put last, and which were since their light was worked out. */
  private readonly placed = new Map<number, Placed>();
  private readonly moved = new Set<number>();

  private constructor(
    readonly scene: SceneShape,
    nodes: Map<string, Object3D>,
  ) {
    const shell = nodes.get("room");
    const pieces = scene.furniture.map((piece) => nodes.get(piece.node)).filter((node) => node !== undefined);
    const still = [...(shell ? meshesIn(shell) : []), ...pieces.flatMap(meshesIn)];
    this.window = windowOf(still);
    this.voxels = new Voxels(
      new Box3(new Vector3(scene.x_min, scene.y_min, 0), new Vector3(scene.x_max, scene.y_max, scene.height_m)),
    );
    for (const mesh of pieces.flatMap(meshesIn)) if (!isFlat(mesh)) this.voxels.add(mesh);
    this.ambience = new Ambience(this.voxels);
    this.plain = new Plain(new Brightness(scene, this.window, this.voxels, this.ambience));
    // Light is told at corners: the floor, and what lies on it, show the shade of what stands there.
    const joined = merged(still, (mesh, geometry) => (isFlat(mesh) || isFloor(mesh) ? split(geometry, FINE_M) : geometry));
    this.fixed = meshesIn(joined);
    for (const mesh of this.fixed) {
      mesh.receiveShadow = true;
      const { name } = mesh.material as Material;
      mesh.castShadow = ![...SHELL, ...SHADES].includes(name);
      // What stands before the walls is drawn before them.
      mesh.renderOrder = SHELL.includes(name) ? 1 : 0;
      // For the first picture, to find out how far each reaches takes longer than to draw it.
      mesh.frustumCulled = false;
    }
    this.group.add(joined);
    for (const object of scene.objects) {
      const node = nodes.get(object.node);
      if (!node) continue;
      node.userData.objectId = object.id;
      for (const mesh of meshesIn(node)) {
        mesh.receiveShadow = true;
        mesh.castShadow = (mesh.material as Material).name !== "glass";
        mesh.userData.objectId = object.id;
      }
      this.things.set(object.id, node);
      this.group.add(node);
    }
    this.group.traverse((object) => {
      object.matrixAutoUpdate = false;
    });
    this.looks = meshesIn(this.group).map((mesh) => this.look(mesh, surface(mesh.material as Material)));
  }

  private look(mesh: Mesh, own: Material): Looks {
    const isStill = this.fixed.includes(mesh);
    // Two of a kind share their shape, but not their light.
    if (!isStill) {
      mesh.geometry = sharing(mesh.geometry);
      this.lit.set(mesh, mesh.matrixWorld.clone());
    }
    if (own.name === "outside") this.plain.shine(mesh.geometry);
    else this.plain.begin(mesh.geometry, own);
    return { mesh, own, plain: this.plain.look(own), full: fullLook(own, this.ambience) };
  }

  /** Work out the light on everything, for the plain look; until then it is dark. */
  light(): void {
    const still = new Set(this.fixed);
    for (const { mesh, own } of this.looks) {
      if (own.name !== "outside") this.plain.light(mesh.geometry, own, mesh.matrixWorld, still.has(mesh));
    }
  }

  /** Give everything its full look, or its plain one. */
  dress(isFull: boolean): void {
    for (const { mesh, plain, full } of this.looks) mesh.material = isFull ? full : plain;
  }

  /** From now on, draw only what is in view of what does not move. */
  cull(): void {
    for (const mesh of this.fixed) mesh.frustumCulled = true;
  }

  /** Light things anew that were moved, for the plain look. */
  relight(): void {
    if (!this.moved.size) return;
    for (const { mesh, own } of this.looks) {
      const id = mesh.userData.objectId as number;
      if (!this.moved.has(id) || !this.things.get(id)?.visible) continue;
      const before = this.lit.get(mesh);
      if (!before || isNear(before, mesh.matrixWorld)) continue;
      before.copy(mesh.matrixWorld);
      this.plain.light(mesh.geometry, own, mesh.matrixWorld, false);
    }
    for (const id of this.moved) if (this.things.get(id)?.visible) this.moved.delete(id);
  }

  static of(gltf: GLTF, scene: SceneShape): Room {
    const nodes = nodesByName(gltf);
    nodes.get("world")?.quaternion.identity();
    gltf.scene.updateMatrixWorld(true);
    return new Room(scene, nodes);
  }

  place(id: number, at: Placed): void {
    const thing = this.things.get(id);
    if (!thing || this.placed.get(id) === at) return;
    this.placed.set(id, at);
    this.moved.add(id);
    thing.position.set(at[0], at[1], at[2]);
    thing.quaternion.set(at[3], at[4], at[5], at[6]);
    thing.updateMatrix();
    thing.updateMatrixWorld(true);
  }
}

/** The same shape, to which something of its own may be added. */
export function sharing(geometry: BufferGeometry): BufferGeometry {
  const shape = new BufferGeometry();
  for (const [name, attribute] of Object.entries(geometry.attributes)) shape.setAttribute(name, attribute);
  shape.setIndex(geometry.getIndex());
  // The file tells how far it reaches.
  shape.boundingSphere = geometry.boundingSphere;
  return shape;
}

/** Whether a thing stands almost as before, as far as light goes. */
const isNear = (a: Matrix4, b: Matrix4): boolean =>
  a.elements.every((value, i) => Math.abs(value - (b.elements[i] ?? 0)) < LIT_AGAIN);

/** Whether it lies on the floor or hangs on a wall so flat that nothing can be behind it. */
export function isFlat(mesh: Mesh): boolean {
  // The file tells how far it reaches.
  if (!mesh.geometry.boundingBox) mesh.geometry.computeBoundingBox();
  const size = mesh.geometry.boundingBox?.clone().applyMatrix4(mesh.matrixWorld).getSize(new Vector3());
  return size !== undefined && size.z < 0.03;
}

export const isFloor = (mesh: Mesh): boolean => (mesh.material as Material).name === "parquet";

function windowOf(meshes: readonly Mesh[]): Vector3 | null {
  const pane = meshes.find((mesh) => (mesh.material as Material).name === "outside");
  return pane ? new Box3().setFromObject(pane).getCenter(new Vector3()) : null;
}
