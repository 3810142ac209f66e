// The person: a skinned figure whose joints are set from the poses of the track.

import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import { type Bone, Group, type Material, Matrix4, type Object3D, Quaternion, type SkinnedMesh, Vector3 } from "three";
import { Face } from "./face.ts";
import { type Bearing, Life } from "./life.ts";
import { bonesByName, nodesByName, skinnedIn } from "./loading.ts";
import type { Room } from "./room.ts";
import { Skin } from "./skin.ts";
import { fullLook, surface } from "./surfaces.ts";
import type { Moment } from "../track/track.ts";

/** Parts of the head, which her own eyes do not see. */
const HEAD = ["head", "eyes", "lids", "brows", "lashes", "hair", "teeth", "tongue", "mouth"];
/** From the head's joint to between the eyes, where the file does not say it. */
const EYES = new Vector3(0.09, 0, 0.085);

export class Figure {
  readonly group = new Group();
  readonly meshes: SkinnedMesh[];
  readonly face: Face;
  /** The same body for the plain look. */
  private readonly skins: Skin[];
  private isFull = false;
  private readonly life = new Life(() => this.isFull);
  /** Joints that her bearing turns, and how the motion has them. */
  private readonly borne: { bone: Bone; own: Quaternion; more: Quaternion }[];
  private readonly head: Bone | undefined;
  private readonly feet: Bone[];
  private readonly lids: number;

  private constructor(
    private readonly root: Object3D,
    scene: Object3D,
    private readonly bones: (Bone | undefined)[],
    byName: Map<string, Bone>,
    private readonly room: Room,
  ) {
    this.meshes = skinnedIn(scene);
    this.face = new Face(this.meshes.filter((mesh) => mesh.morphTargetDictionary));
    this.lids = bones.indexOf(byName.get("eyelids"));
    this.head = byName.get("head");
    const { chest, neck, head } = this.life;
    this.borne = Object.entries({ chest, neck, head }).flatMap(([name, more]) => {
      const bone = byName.get(name);
      return bone ? [{ bone, own: bone.quaternion.clone(), more }] : [];
    });
    this.feet = ["leftFoot", "rightFoot"].map((name) => byName.get(name)).filter((bone) => bone !== undefined);
    for (const mesh of this.meshes) {
      mesh.frustumCulled = false;
      mesh.castShadow = mesh.receiveShadow = true;
      const { name } = mesh.material as Material;
      if (["lids", "brows", "lashes", "eyes"].includes(name)) mesh.castShadow = false;
    }
    this.skins = this.meshes.map((mesh) => new Skin(mesh, room.plain));
    for (const mesh of this.meshes) mesh.material = fullLook(surface(mesh.material as Material), room.ambience);
    this.group.add(root, ...this.meshes, ...this.skins.map((skin) => skin.shown));
  }

  static of(gltf: GLTF, joints: readonly string[], room: Room): Figure {
    const root = nodesByName(gltf).get("human") ?? gltf.scene;
    const byName = bonesByName(gltf);
    return new Figure(root, gltf.scene, joints.map((joint) => byName.get(joint)), byName, room);
  }

  pose(moment: Moment): void {
    const [x, y, heading] = moment.body;
    this.root.position.set(x, y, 0);
    this.root.quaternion.set(0, 0, Math.sin(heading / 2), Math.cos(heading / 2));
    this.bones.forEach((bone, i) => {
      const q = moment.joints;
      if (bone && i !== this.lids && q.length >= i * 4 + 4) {
        bone.quaternion.set(q[i * 4] ?? 0, q[i * 4 + 1] ?? 0, q[i * 4 + 2] ?? 0, q[i * 4 + 3] ?? 1);
      }
    });
    // The lids turn about the Y axis; the face has a shape for it that lies flush.
    if (this.lids >= 0) this.face.turnLids(2 * Math.asin(moment.joints[this.lids * 4 + 1] ?? 0));
    this.bones[0]?.position.set(...moment.pelvis);
    for (const { bone, own } of this.borne) own.copy(bone.quaternion);
    this.bear();
  }

  /**
   * Let her bearing go on, on top of the motion; returns whether anything moved.
   * @param viewer Where whoever looks on is, in the room.
   */
  live(seconds: number, bearing: Bearing, viewer: Vector3): boolean {
    const below = this.borne[0]?.bone.parent;
    if (!below) return false;
    // As the motion has trunk and head: what her bearing adds would lead it on.
    const from = below.matrixWorld.clone();
    for (const { bone, own } of this.borne) from.multiply(new Matrix4().compose(bone.position, own, bone.scale));
    const moved = this.life.update(seconds, bearing, viewer.clone().applyMatrix4(from.invert()).sub(EYES));
    if (moved) this.bear();
    return moved;
  }

  private bear(): void {
    for (const { bone, own, more } of this.borne) bone.quaternion.copy(own).multiply(more);
    this.group.updateMatrixWorld(true);
    for (const skin of this.skins) skin.isStale = true;
  }

  /** Give her the full look, or the plain one. */
  dress(isFull: boolean): void {
    this.isFull = isFull;
  }

  /**
   * Get ready for a picture.
   * @param isWhole Whether her head is seen: whoever looks out of it does not see it.
   */
  prepare(isWhole: boolean): void {
    const show = (mesh: Object3D, isWorn: boolean, { name }: Material): void => {
      mesh.visible = isWorn && (isWhole || !HEAD.includes(name));
    };
    for (const mesh of this.meshes) show(mesh, this.isFull, mesh.material as Material);
    for (const { shown } of this.skins) show(shown, !this.isFull, shown.material as Material);
    if (this.isFull) return;
    const { x, y } = this.root.position;
    const light = this.room.plain.around(x, y);
    for (const skeleton of new Set(this.meshes.map((mesh) => mesh.skeleton))) skeleton.update();
    for (const skin of this.skins) if (skin.shown.visible) skin.update(light);
  }

  /** Where her eyes are and which way they look, in the room. */
  eyes(): { place: Vector3; forward: Vector3; up: Vector3 } {
    const matrix = this.head?.matrixWorld ?? new Matrix4();
    return {
      place: EYES.clone().applyMatrix4(matrix),
      forward: new Vector3(1, 0, 0).transformDirection(matrix),
      up: new Vector3(0, 0, 1).transformDirection(matrix),
    };
  }

  /** Top of the head. */
  crown(): Vector3 {
    return new Vector3(0, 0, 0.24).applyMatrix4(this.head?.matrixWorld ?? this.root.matrixWorld);
  }

  /** Where the feet stand. */
  footPlaces(): Vector3[] {
    return this.feet.map((bone) => new Vector3(0.06, 0, 0).applyMatrix4(bone.matrixWorld));
  }
}
