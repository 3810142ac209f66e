// The person: a skinned figure whose joints are set from the poses of the track.

import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import { type Bone, Group, type Material, Matrix4, type Object3D, Quaternion, type Skeleton, type SkinnedMesh, Vector3 } from "three";
import { Face } from "./face.ts";
import { type Bearing, Life, type Look } from "./life.ts";
import { bonesByName, nodesByName, skinnedIn } from "./loading.ts";
import type { Room } from "./room.ts";
import { Skin } from "./skin.ts";
import { fullLook, surface } from "./surfaces.ts";
import type { Moment } from "../track/track.ts";

/** Parts of the head, which her own eyes do not see. */
const HEAD = ["head", "eyes", "lids", "brows", "lashes", "hair", "teeth", "tongue", "mouth"];
/** From the head's joint to between the eyes, where the file does not say it. */
const EYES = new Vector3(0.09, 0, 0.085);
const turn = new Quaternion();
const below = new Matrix4();
const above = new Matrix4();
const seen = new Vector3();

export class Figure {
  readonly group = new Group();
  readonly meshes: SkinnedMesh[];
  readonly face: Face;
  /** The same body for the plain look. */
  private readonly skin: Skin;
  private isFull = false;
  /** Whether her head was seen last. */
  private isWhole = true;
  /** How the motion turns her eyes. */
  private readonly gaze: Look = { yaw: 0, pitch: 0 };
  private readonly life = new Life(() => this.isFull);
  /** Joints that her bearing turns, and how the motion has them. */
  private readonly borne: { bone: Bone; joint: number; own: Quaternion; more: Quaternion }[];
  private readonly head: Bone | undefined;
  private readonly feet: Bone[];
  private readonly lids: number;
  private readonly skeletons: ReadonlySet<Skeleton>;

  private constructor(
    private readonly root: Object3D,
    scene: Object3D,
    private readonly bones: (Bone | undefined)[],
    byName: Map<string, Bone>,
    private readonly room: Room,
  ) {
    // Nothing of it is drawn: it is turned here, once for each pose.
    root.removeFromParent();
    for (const bone of byName.values()) {
      bone.updateMatrix();
      bone.matrixAutoUpdate = false;
    }
    this.meshes = skinnedIn(scene);
    this.face = new Face(this.meshes.filter((mesh) => mesh.morphTargetDictionary));
    this.lids = bones.indexOf(byName.get("eyelids"));
    this.head = byName.get("head");
    const { chest, neck, head } = this.life;
    this.borne = Object.entries({ chest, neck, head }).flatMap(([name, more]) => {
      const bone = byName.get(name);
      return bone ? [{ bone, joint: bones.indexOf(bone), own: bone.quaternion.clone(), more }] : [];
    });
    this.feet = ["leftFoot", "rightFoot"].map((name) => byName.get(name)).filter((bone) => bone !== undefined);
    for (const mesh of this.meshes) {
      mesh.frustumCulled = false;
      mesh.castShadow = mesh.receiveShadow = true;
      const { name } = mesh.material as Material;
      if (["lids", "brows", "lashes", "eyes"].includes(name)) mesh.castShadow = false;
    }
    this.skeletons = new Set(this.meshes.map((mesh) => mesh.skeleton));
    this.skin = new Skin(this.meshes, room.plain);
    for (const mesh of this.meshes) mesh.material = fullLook(surface(mesh.material as Material), room.ambience);
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
    const q = moment.joints;
    this.bones.forEach((bone, i) => {
      if (!bone || i === this.lids || q.length < i * 4 + 4) return;
      if (i === 0) bone.position.set(...moment.pelvis);
      bone.matrix.compose(bone.position, turn.fromArray(q, i * 4), bone.scale);
    });
    // The lids turn about the Y axis; the face has a shape for it that lies flush.
    if (this.lids >= 0) this.face.turnLids(2 * Math.asin(q[this.lids * 4 + 1] ?? 0));
    for (const { own, joint } of this.borne) if (joint >= 0 && q.length >= joint * 4 + 4) own.fromArray(q, joint * 4);
    [this.gaze.yaw, this.gaze.pitch] = moment.eyes;
    this.bear();
  }

  /**
   * Let her bearing go on, on top of the motion; returns whether anything moved.
   * @param viewer Where whoever looks on is, in the room.
   */
  live(seconds: number, bearing: Bearing, viewer: Vector3): boolean {
    const base = this.borne[0]?.bone.parent;
    if (!base) return false;
    // As the motion has trunk and head: what her bearing adds would lead it on.
    below.copy(base.matrixWorld);
    for (const { bone, own } of this.borne) below.multiply(above.compose(bone.position, own, bone.scale));
    const from = seen.copy(viewer).applyMatrix4(below.invert()).sub(EYES);
    const moved = this.life.update(seconds, bearing, from, this.gaze);
    if (moved) {
      this.face.look(this.life.eyes.yaw, this.life.eyes.pitch);
      if (this.life.isTurned) this.bear();
    }
    return moved;
  }

  private bear(): void {
    for (const { bone, own, more } of this.borne) bone.matrix.compose(bone.position, turn.multiplyQuaternions(own, more), bone.scale);
    this.root.updateMatrixWorld(true);
    this.skin.isStale = true;
  }

  /** Give her the full look, or the plain one. */
  dress(isFull: boolean): void {
    this.isFull = isFull;
    // What is not shown need not be looked through for each picture.
    this.group.remove(...this.meshes, this.skin.shown);
    if (isFull) this.group.add(...this.meshes);
    else this.group.add(this.skin.shown);
  }

  /**
   * Get ready for a picture.
   * @param isWhole Whether her head is seen: whoever looks out of it does not see it.
   */
  prepare(isWhole: boolean): void {
    const isSeen = ({ name }: Material): boolean => isWhole || !HEAD.includes(name);
    if (this.isFull) {
      for (const mesh of this.meshes) mesh.visible = isSeen(mesh.material as Material);
      return;
    }
    if (this.isWhole !== isWhole) for (const material of this.skin.shown.material) material.visible = isSeen(material);
    this.isWhole = isWhole;
    const { x, y } = this.root.position;
    for (const skeleton of this.skeletons) skeleton.update();
    this.skin.update(this.room.plain.around(x, y));
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
