// Where the room is seen from: freely, behind her, or through her eyes. Never from inside anything.

import { PerspectiveCamera, Vector3 } from "three";
import type { BodyShape, SceneShape } from "../protocol.ts";
import type { Moment } from "../track/track.ts";
import type { Figure } from "./figure.ts";
import type { Voxels } from "./voxels.ts";

export type CameraKind = "free" | "follow" | "eyes";

const WALL_M = 0.22;
const NEAREST_M = 0.45;
const FOLLOW_M = 2.5;
const UP = new Vector3(0, 0, 1);
const ASIDE = [0.5, -0.5, 1.0, -1.0, 1.6, -1.6, 2.3, -2.3, Math.PI];

/** A direction of a heading and an elevation, radians. */
const towards = (heading: number, up: number): Vector3 =>
  new Vector3(Math.cos(heading) * Math.cos(up), Math.sin(heading) * Math.cos(up), Math.sin(up));

/** One exponential step towards a goal, the same whatever the frame rate. */
const ease = (seconds: number, per: number): number => 1 - Math.exp(-seconds / per);

export class Cameras {
  readonly camera = new PerspectiveCamera(52, 1, 0.05, 40);
  kind: CameraKind = "free";
  /** What the free camera turns around, from which side, how far away. */
  readonly target = new Vector3();
  heading = 0;
  elevation = 0.3;
  distance = 4;
  private readonly place = new Vector3();
  private readonly aim = new Vector3();
  private side = 0;
  private settled = false;
  /** Whether somebody has taken the free camera: until then it turns after her. */
  private taken = false;
  private readonly calm = matchMedia("(prefers-reduced-motion: reduce)").matches;

  constructor(
    private readonly scene: SceneShape,
    private readonly body: BodyShape,
    private readonly voxels: Voxels,
  ) {
    this.camera.up.copy(UP);
  }

  choose(kind: CameraKind): void {
    if (kind === "free" && this.kind !== "free") this.stayHere();
    this.kind = kind;
    this.side = 0;
    if (this.calm) this.settled = false;
  }

  /** Go on freely from where the camera is now. */
  private stayHere(): void {
    const back = this.place.clone().sub(this.aim);
    if (back.length() < NEAREST_M) return;
    this.target.copy(this.aim);
    this.distance = back.length();
    this.heading = Math.atan2(back.y, back.x);
    this.elevation = Math.asin(back.z / this.distance);
  }

  /** Stand in the corner that shows her best and most of the room. */
  begin(moment: Moment): void {
    const { scene } = this;
    const [x, y, heading] = moment.body;
    const middle = new Vector3((scene.x_min + scene.x_max) / 2, (scene.y_min + scene.y_max) / 2, 0);
    const her = new Vector3(x, y, 1.15);
    this.target.set(x, y, 0.95).lerp(new Vector3(middle.x, middle.y, 0.75), 0.4);
    let best = -Infinity;
    for (const cx of [scene.x_min + 0.4, scene.x_max - 0.4]) {
      for (const cy of [scene.y_min + 0.4, middle.y, scene.y_max - 0.4]) {
        const corner = new Vector3(cx, cy, Math.min(2.35, scene.height_m - 0.5));
        const way = corner.clone().sub(her);
        const far = way.length();
        const seen = this.voxels.free(her, way.clone().normalize(), far) / far;
        const facing = (Math.cos(heading) * way.x + Math.sin(heading) * way.y) / far;
        const value = seen * 2 + facing * 0.9 - Math.abs(far - 4.2) * 0.22;
        if (value <= best) continue;
        best = value;
        const back = corner.sub(this.target);
        this.distance = back.length();
        this.heading = Math.atan2(back.y, back.x);
        this.elevation = Math.asin(back.z / this.distance);
      }
    }
    this.settled = false;
  }

  /** Leave the free camera to whoever moves it. */
  private take(): void {
    if (!this.taken && this.kind === "free") this.stayHere();
    this.taken = true;
  }

  turn(dx: number, dy: number): void {
    this.take();
    this.heading -= dx;
    this.elevation = Math.min(1.35, Math.max(-0.25, this.elevation + dy));
  }

  zoom(factor: number): void {
    this.take();
    this.distance = Math.min(9, Math.max(0.7, this.distance * factor));
  }

  pan(dx: number, dy: number): void {
    this.take();
    const right = towards(this.heading + Math.PI / 2, 0);
    this.target.addScaledVector(right, -dx * this.distance).addScaledVector(UP, dy * this.distance);
    this.keepInside(this.target, 0.3);
  }

  private keepInside(point: Vector3, margin: number): void {
    const { scene } = this;
    point.x = Math.min(scene.x_max - margin, Math.max(scene.x_min + margin, point.x));
    point.y = Math.min(scene.y_max - margin, Math.max(scene.y_min + margin, point.y));
    point.z = Math.min(scene.height_m - margin, Math.max(0.12, point.z));
  }

  /** The furthest place on a ray that is inside the room and not behind or in anything. */
  private reachable(from: Vector3, direction: Vector3, far: number): Vector3 {
    const { scene } = this;
    let most = far;
    const limit = (at: number, way: number, low: number, high: number): void => {
      if (way > 1e-6) most = Math.min(most, (high - at) / way);
      else if (way < -1e-6) most = Math.min(most, (low - at) / way);
    };
    limit(from.x, direction.x, scene.x_min + WALL_M, scene.x_max - WALL_M);
    limit(from.y, direction.y, scene.y_min + WALL_M, scene.y_max - WALL_M);
    limit(from.z, direction.z, 0.15, scene.height_m - WALL_M);
    const free = this.voxels.free(from, direction, Math.max(most, 0));
    const place = from.clone().addScaledVector(direction, Math.max(NEAREST_M, Math.min(most, free)));
    this.keepInside(place, WALL_M * 0.8);
    return place;
  }

  /** Follow the moment. Returns whether the camera moved. */
  update(moment: Moment, figure: Figure, seconds: number): boolean {
    const before = this.camera.matrixWorld.elements.slice();
    if (this.kind === "eyes") this.throughHerEyes(figure);
    else {
      const wish = this.kind === "free" ? this.free(moment) : this.behind(moment);
      const slow = this.kind === "free" && this.taken ? 0.07 : 0.35;
      const share = this.settled && !this.calm ? ease(seconds, slow) : 1;
      this.place.lerp(wish.place, share);
      this.aim.lerp(wish.aim, share);
      this.camera.up.copy(UP);
      this.camera.position.copy(this.place);
      this.camera.lookAt(this.aim);
      this.setView(this.camera.aspect < 0.9 ? 66 : 52);
    }
    this.settled = this.kind !== "eyes";
    this.camera.updateMatrixWorld();
    return this.camera.matrixWorld.elements.some((value, i) => Math.abs(value - (before[i] ?? 0)) > 1e-5);
  }

  private free(moment: Moment): { place: Vector3; aim: Vector3 } {
    const [x, y] = moment.body;
    const place = this.reachable(this.target, towards(this.heading, this.elevation), this.distance);
    const aim = this.target.clone();
    return { place, aim: this.taken ? aim : aim.lerp(new Vector3(x, y, 0.95), 0.7) };
  }

  private behind(moment: Moment): { place: Vector3; aim: Vector3 } {
    const [x, y, heading] = moment.body;
    const chest = new Vector3(x, y, 1.3);
    const at = (aside: number): Vector3 =>
      this.reachable(chest, towards(heading + Math.PI + aside, 0.2), FOLLOW_M);
    // The side that was good stays so, as long as she is seen well from it.
    let place = at(this.side || 0.5);
    if (this.side === 0 || place.distanceTo(chest) < FOLLOW_M * 0.5) {
      for (const aside of ASIDE) {
        const other = at(aside);
        if (other.distanceTo(chest) > place.distanceTo(chest) + 0.4) {
          place = other;
          this.side = aside;
        }
      }
      this.side ||= 0.5;
    }
    return { place, aim: chest.addScaledVector(towards(heading, -0.15), 0.7) };
  }

  private throughHerEyes(figure: Figure): void {
    const { place, forward, up } = figure.eyes();
    this.place.copy(place);
    this.aim.copy(place).add(forward);
    this.camera.up.copy(up);
    this.camera.position.copy(place);
    this.camera.lookAt(this.aim);
    this.setView((this.body.fov_y_rad * 180) / Math.PI);
  }

  private setView(fov: number): void {
    if (Math.abs(this.camera.fov - fov) < 0.01) return;
    this.camera.fov = fov;
    this.camera.updateProjectionMatrix();
  }

  resize(width: number, height: number): void {
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
  }
}
