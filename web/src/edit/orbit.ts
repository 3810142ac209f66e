// The editor's camera: around a point of the room, also from above and from outside.

import { PerspectiveCamera, Vector3 } from "three";
import type { Steered } from "../view/pointer.ts";
import type { SceneData, Two } from "./scene.ts";

const UP = new Vector3(0, 0, 1);
const FAR_M = 22;

export class Orbit implements Steered {
  readonly kind = "free";
  readonly camera = new PerspectiveCamera(44, 1, 0.05, 80);
  readonly target = new Vector3();
  heading = -Math.PI / 2 - 0.5;
  elevation = 0.86;
  distance = 8;

  constructor(private readonly room: SceneData["room"]) {
    this.camera.up.copy(UP);
    this.target.set((room.x_min + room.x_max) / 2, (room.y_min + room.y_max) / 2, 0.4);
  }

  choose(): void {
    // There is one alone.
  }

  turn(dx: number, dy: number): void {
    this.heading -= dx;
    this.elevation = Math.min(1.55, Math.max(0.08, this.elevation + dy));
    this.update();
  }

  zoom(factor: number): void {
    this.distance = Math.min(FAR_M, Math.max(0.6, this.distance * factor));
    this.update();
  }

  pan(dx: number, dy: number): void {
    const right = new Vector3(-Math.sin(this.heading), Math.cos(this.heading), 0);
    const away = new Vector3(-Math.cos(this.heading), -Math.sin(this.heading), 0);
    this.target.addScaledVector(right, -dx * this.distance).addScaledVector(away, dy * this.distance);
    this.look(this.target);
  }

  /** Turn around another point from now on. */
  look({ x, y, z }: { x: number; y: number; z: number }): void {
    const { room } = this;
    const within = (value: number, low: number, high: number): number => Math.min(high, Math.max(low, value));
    this.target.set(within(x, room.x_min, room.x_max), within(y, room.y_min, room.y_max), within(z, 0, room.height_m));
    this.update();
  }

  resize(width: number, height: number): void {
    const before = this.camera.aspect;
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
    if (before === 1) this.showAll();
    this.update();
  }

  /** As near as the whole room allows. */
  private showAll(): void {
    const { x_min, x_max, y_min, y_max } = this.room;
    const half = Math.hypot(x_max - x_min, y_max - y_min) / 2;
    const across = Math.tan(((this.camera.fov / 2) * Math.PI) / 180) * Math.min(1, this.camera.aspect);
    this.distance = Math.min(FAR_M, (half / across) * 1.02);
  }

  update(): void {
    const flat = Math.cos(this.elevation) * this.distance;
    const offset = new Vector3(Math.cos(this.heading) * flat, Math.sin(this.heading) * flat, Math.sin(this.elevation) * this.distance);
    this.camera.position.copy(this.target).add(offset);
    this.camera.lookAt(this.target);
    this.camera.updateMatrixWorld();
  }
}

/** The direction along the room's walls that an arrow key points to, as seen from a camera of this heading. */
export function along(heading: number, key: string): Two {
  const quarter = Math.round((heading + Math.PI) / (Math.PI / 2));
  const more = { ArrowUp: 0, ArrowLeft: 1, ArrowDown: 2, ArrowRight: 3 }[key];
  if (more === undefined) return [0, 0];
  const angle = (quarter + more) * (Math.PI / 2);
  return [Math.round(Math.cos(angle)) + 0, Math.round(Math.sin(angle)) + 0];
}
