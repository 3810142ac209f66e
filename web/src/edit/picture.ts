// The room that is edited, in 3D: drawn anew only when something changed.

import {
  Box3,
  Box3Helper,
  Color,
  Group,
  type Material,
  Mesh,
  type Object3D,
  PCFShadowMap,
  Plane,
  Raycaster,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { type Lights, lightRoom } from "../view/lights.ts";
import { meshesIn } from "../view/loading.ts";
import { drawsPlainly } from "../view/machine.ts";
import { Overlay } from "../view/overlay.ts";
import { across } from "../view/pointing.ts";
import type { Draft } from "./draft.ts";
import { Orbit } from "./orbit.ts";
import { areaMesh, Assets, lightMesh, loadShell, startMesh } from "./pieces.ts";
import { Plainly, type Standing } from "./plainly.ts";
import { meshOfScene } from "./remote.ts";
import { type Catalog, isSame, keyOf, nameOf, type Ref, type SceneData, type Three } from "./scene.ts";
import { heightOf, radians } from "./support.ts";

const ACCENT = 0xf0976a;
/** The light of the scenes that the page was made for, which is shown as full. */
const FULL_LIGHT = 1.68;
const NO_SIZE: Three = [0.2, 0.2, 0.2];

export interface Hit {
  ref: Ref | null;
  point: Vector3;
  /** Outwards from the surface. */
  normal: Vector3;
}

interface Shown {
  node: Object3D;
  /** What it was made for; another one needs another mesh. */
  made: string;
  ref: Ref;
}

export class Picture {
  readonly orbit: Orbit;
  readonly overlay = new Overlay();
  private readonly scene = new Scene();
  private readonly renderer: WebGLRenderer;
  private readonly lights: Lights;
  private readonly assets: Assets;
  private readonly shown = new Map<string, Shown>();
  private readonly ray = new Raycaster();
  private readonly box = new Box3Helper(new Box3(), new Color(ACCENT));
  /** Around what is selected, turned as it is. */
  private readonly frame = new Group().add(this.box);
  /** Draws plainly where a processor draws. */
  private readonly plainly: Plainly | null;
  private shell: Object3D | null = null;
  /** What stood where when it was shown last. */
  private places = "";
  private isAsked = false;
  private isClosed = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly draft: Draft,
    private readonly catalog: Catalog,
  ) {
    const isPlain = drawsPlainly();
    this.renderer = new WebGLRenderer({ canvas, antialias: !isPlain, alpha: true });
    this.renderer.shadowMap.enabled = !isPlain;
    this.renderer.shadowMap.type = PCFShadowMap;
    const { room } = draft.data;
    this.orbit = new Orbit(room);
    this.lights = lightRoom(room, null, true);
    this.lights.shadowSize(1024);
    this.assets = new Assets(() => this.update(), isPlain);
    this.plainly = isPlain ? new Plainly(room, () => this.standing(), () => this.touch()) : null;
    this.scene.add(this.lights.group, this.frame);
    draft.changes.listen(() => this.update());
    this.update();
  }

  /** The walls come with the scene that one began with. */
  async open(sceneName: string): Promise<void> {
    const shell = await loadShell(meshOfScene(sceneName), this.draft.data.room, this.plainly !== null);
    this.scene.add(shell);
    this.shell = shell;
    this.plainly?.dress(shell);
    this.plainly?.soon();
    this.update();
  }

  /** What light falls on. */
  private standing(): Standing[] {
    const pieces = [...this.shown.values()].map(({ node, ref }): Standing => ({ node, kind: ref.kind === "furniture" ? "furniture" : "object" }));
    return this.shell ? [...pieces, { node: this.shell, kind: "walls" }] : pieces;
  }

  /** Show the scene as it is now. */
  private update(): void {
    const { data, selected } = this.draft;
    const left = new Set(this.shown.keys());
    const fresh: Object3D[] = [];
    const show = (ref: Ref, made: string, make: () => Object3D): Object3D => {
      const key = keyOf(ref);
      left.delete(key);
      const known = this.shown.get(key);
      if (known?.made === made) return known.node;
      if (known) this.scene.remove(known.node);
      const node = make();
      this.shown.set(key, { node, made, ref });
      this.scene.add(node);
      fresh.push(node);
      return node;
    };
    data.furniture.forEach((piece, index) => {
      const node = show({ kind: "furniture", index }, this.look(piece.asset), () => this.mesh(piece.asset, true));
      node.position.set(...piece.position, 0);
      node.rotation.z = radians(piece.yaw_deg);
    });
    data.objects.forEach((item, index) => {
      const node = show({ kind: "objects", index }, this.look(item.asset), () => this.mesh(item.asset, false));
      const height = this.catalog.objects.get(item.asset)?.size[2] ?? 0;
      node.position.set(...item.position, heightOf(item.on, data, this.catalog) + height / 2);
      node.rotation.z = radians(item.yaw_deg);
    });
    data.areas.forEach((area, index) => {
      const isHeld = isSame(selected, { kind: "areas", index });
      show({ kind: "areas", index }, JSON.stringify([area.min, area.max, isHeld]), () => areaMesh(area, isHeld));
    });
    data.lights.forEach((light, index) => {
      show({ kind: "lights", index }, JSON.stringify(light), () => lightMesh(light)).position.set(...light.position);
    });
    const start = show({ kind: "agent", index: 0 }, "", startMesh);
    start.position.set(...data.agent.position, 0);
    start.rotation.z = radians(data.agent.heading_deg);
    for (const key of left) {
      const gone = this.shown.get(key);
      if (gone) this.scene.remove(gone.node);
      this.shown.delete(key);
    }
    for (const node of fresh) this.plainly?.dress(node);
    const places = JSON.stringify([data.furniture, data.objects]);
    if (fresh.length || places !== this.places) this.plainly?.soon();
    this.places = places;
    this.brighten(data);
    this.enframe(selected);
    this.lights.refresh();
    this.touch();
  }

  private look(asset: string): string {
    return `${asset} ${this.assets.has(asset)}`;
  }

  private mesh(asset: string, isFurniture: boolean): Object3D {
    const kind = isFurniture ? this.catalog.furniture : this.catalog.objects;
    return this.assets.copy(asset, kind.get(asset)?.size ?? NO_SIZE, isFurniture);
  }

  private brighten(data: SceneData): void {
    const sum = data.lights.reduce((total, { diffuse }) => total + diffuse, data.ambient);
    const share = Math.min(1.6, sum / FULL_LIGHT);
    this.lights.dim(share);
    this.plainly?.dim(share);
  }

  private enframe(selected: Ref | null): void {
    const node = selected && this.shown.get(keyOf(selected))?.node;
    this.frame.visible = Boolean(node);
    if (!node) return;
    const { position, rotation } = node;
    this.frame.position.copy(position);
    this.frame.rotation.copy(rotation);
    // Its own box is what it fills where nothing is moved or turned.
    position.set(0, 0, 0);
    rotation.set(0, 0, 0);
    node.updateMatrixWorld(true);
    this.box.box.setFromObject(node, true).expandByScalar(0.012);
    position.copy(this.frame.position);
    rotation.copy(this.frame.rotation);
    node.updateMatrixWorld(true);
  }

  /** What the pointer is on: a thing, the floor, or nothing. Whatever `leave` says is looked through. */
  at(event: { clientX: number; clientY: number }, leave: (ref: Ref) => boolean = () => false): Hit | null {
    this.aim(event);
    const meshes = [...this.shown.values()].filter(({ ref }) => !leave(ref)).flatMap(({ node, ref }) => meshesIn(node).map((mesh) => ({ mesh, ref })));
    const hit = this.ray.intersectObjects<Mesh>(meshes.map(({ mesh }) => mesh), false)[0];
    if (hit) {
      const normal = (hit.face?.normal.clone() ?? new Vector3(0, 0, 1)).transformDirection(hit.object.matrixWorld);
      // A surface with two sides shows the one that one looks at.
      if (normal.dot(this.ray.ray.direction) > 0) normal.negate();
      return { ref: meshes.find(({ mesh }) => mesh === hit.object)?.ref ?? null, point: hit.point, normal };
    }
    const point = this.atHeight(event, 0);
    return point && { ref: null, point, normal: new Vector3(0, 0, 1) };
  }

  /** Where the pointer meets a level plane. */
  atHeight(event: { clientX: number; clientY: number }, height: number): Vector3 | null {
    this.aim(event);
    return this.ray.ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -height), new Vector3());
  }

  private aim(event: { clientX: number; clientY: number }): void {
    this.ray.setFromCamera(across(this.canvas, event), this.orbit.camera);
  }

  /** Where something is in the room; null if it has no place. */
  middleOf(ref: Ref): Vector3 | null {
    const node = this.shown.get(keyOf(ref))?.node;
    return node ? new Box3().setFromObject(node).getCenter(new Vector3()) : null;
  }

  /** Bring something into view, if it is not. */
  lead(ref: Ref): void {
    const middle = this.middleOf(ref);
    if (!middle) return;
    const seen = middle.clone().project(this.orbit.camera);
    if (Math.max(Math.abs(seen.x), Math.abs(seen.y)) > 0.85) this.orbit.look(middle);
    this.touch();
  }

  resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.orbit.resize(width, height);
    this.touch();
  }

  /** Draw soon. */
  touch(): void {
    if (this.isAsked || this.isClosed) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      if (!this.isClosed) this.draw();
    });
  }

  private draw(): void {
    const { camera } = this.orbit;
    this.renderer.render(this.scene, camera);
    const { data, selected } = this.draft;
    const labels = [...this.shown.values()].flatMap(({ ref, node }) => {
      const isSelected = isSame(ref, selected);
      if (!isSelected && ref.kind !== "areas") return [];
      const box = new Box3().setFromObject(node);
      const place = box.getCenter(new Vector3()).setZ(box.max.z);
      return [{ text: nameOf(data, ref), place, kind: ref.kind === "areas" ? ("point" as const) : ("" as const), bright: isSelected }];
    });
    this.overlay.show(labels, camera);
  }

  close(): void {
    this.isClosed = true;
    this.plainly?.close();
    for (const mesh of meshesIn(this.scene)) {
      mesh.geometry.dispose();
      (mesh.material as Material).dispose();
    }
    this.renderer.dispose();
  }
}
