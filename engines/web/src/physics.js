// Havok: what rays hit, and how an object that is put down comes to rest on what carries it.

import "@babylonjs/core/Physics/joinedPhysicsEngineComponent.js";
import "@babylonjs/core/Physics/v2/physicsEngineComponent.js";
import HavokPhysics from "@babylonjs/havok";
import { Quaternion, Vector3 } from "@babylonjs/core/Maths/math.vector.js";
import { HavokPlugin } from "@babylonjs/core/Physics/v2/Plugins/havokPlugin.js";
import { PhysicsBody } from "@babylonjs/core/Physics/v2/physicsBody.js";
import { PhysicsMotionType, PhysicsShapeType } from "@babylonjs/core/Physics/v2/IPhysicsEnginePlugin.js";
import { PhysicsRaycastResult } from "@babylonjs/core/Physics/physicsRaycastResult.js";
import { PhysicsShape } from "@babylonjs/core/Physics/v2/physicsShape.js";
import { TransformNode } from "@babylonjs/core/Meshes/transformNode.js";
import { at, corners, plus, times } from "./geometry.js";
import { fromPage, toPage, turnFromPage, turnToPage } from "./frame.js";

const FAR_M = 40;
const STEP_S = 1 / 240;
const LONGEST_S = 4;
const STILL_M_S = 0.004;
const STILL_RAD_S = 0.08;
const CREEP_M = 0.002;
const CREEP_RAD = 0.01;
const LIFT_M = 0.001;
const PROBE_M = 0.03;
const MASS_KG = 0.3;
const MATERIAL = { friction: 0.8, restitution: 0 };
/** So many steps it falls at least before it can be at rest. */
const FALLING = 24;
/** What rays for the eyes hit, what carries, and rays themselves. */
const SEEN = 1;
const CARRIES = 2;
const RAY = 4;
const DOWN = at(0, 0, -1);

export class Physics {
  /**
   * @param stage Has loaded its scene.
   * @param world What is in it.
   * @param wasm Address of Havok's program.
   */
  static async made(stage, world, wasm) {
    return new Physics(stage, world, await HavokPhysics({ locateFile: () => wasm }));
  }

  /** Meshes stop rays; prisms and hulls, which are exact, carry what is put down. */
  constructor(stage, world, havok) {
    this.scene = stage.scene;
    const plugin = new HavokPlugin(false, havok);
    plugin.setTimeStep(STEP_S);
    this.scene.enablePhysics(new Vector3(0, -9.81, 0), plugin);
    this.scene.physicsEnabled = false; // It runs when something is put down, not with the pictures.
    this.engine = this.scene.getPhysicsEngine();
    this.names = new Map();
    this.seen = new Map();
    this.hulls = new Map();
    this.held = null;
    for (const thing of [stage.room, ...stage.furniture.values()]) this._stopRays(thing.root);
    for (const { name, solid } of world.carriers()) this._carry(name, solid);
    for (const [id, { root }] of stage.objects) {
      this.seen.set(id, this._stopRays(root));
      this.hulls.set(id, this._hull(root, `object ${id}`));
    }
  }

  _stopRays(root) {
    return this._body(root, { type: PhysicsShapeType.MESH, parameters: { mesh: root, includeChildMeshes: true } }, SEEN);
  }

  _hull(root, name) {
    const shape = { type: PhysicsShapeType.CONVEX_HULL, parameters: { mesh: root, includeChildMeshes: true } };
    const node = new TransformNode(name, this.scene);
    node.rotationQuaternion = Quaternion.Identity();
    const body = this._body(node, shape, CARRIES);
    body.shape.material = MATERIAL;
    this.names.set(body, name);
    return body;
  }

  _carry(name, solid) {
    const node = new TransformNode(name, this.scene);
    const half = solid.yaw_rad / 2;
    node.rotationQuaternion = new Quaternion(...turnToPage({ w: Math.cos(half), x: 0, y: 0, z: Math.sin(half) }));
    node.position.set(...toPage({ ...solid, z: (solid.z_min + solid.z_max) / 2 }));
    const extents = new Vector3(2 * solid.half_x, solid.z_max - solid.z_min, 2 * solid.half_y);
    const shape = { type: PhysicsShapeType.BOX, parameters: { center: Vector3.Zero(), rotation: Quaternion.Identity(), extents } };
    const body = this._body(node, shape, CARRIES);
    body.shape.material = MATERIAL;
    this.names.set(body, name);
  }

  _body(node, shape, mask) {
    const body = new PhysicsBody(node, PhysicsMotionType.STATIC, false, this.scene);
    body.shape = new PhysicsShape(shape, this.scene);
    body.shape.filterMembershipMask = mask;
    body.shape.filterCollideMask = mask === CARRIES ? CARRIES | RAY : RAY;
    this._hold(body);
    return body;
  }

  /** Let a body stay where its node is. */
  _hold(body) {
    body.setMotionType(PhysicsMotionType.STATIC);
    body.disablePreStep = false;
    body.disableSync = true;
  }

  /** Take over where things are. @param held The object that rays pass, or null. */
  follow(objects, held) {
    this.held = held;
    for (const { id, box } of objects) this._put(this.hulls.get(id), box);
    this.engine._step(STEP_S);
  }

  /** First hits of rays, or null, in ADAMO's frame. */
  rays(origin, ways) {
    const ignored = this.held === null ? undefined : this.seen.get(this.held);
    return ways.map((way) => this._ray(origin, way, FAR_M, SEEN, ignored)?.point ?? null);
  }

  _ray(origin, way, length, collideWith, ignoreBody) {
    const hit = new PhysicsRaycastResult();
    const from = new Vector3(...toPage(origin));
    const to = new Vector3(...toPage(plus(origin, times(way, length))));
    this.engine.raycastToRef(from, to, hit, { membership: RAY, collideWith, ignoreBody });
    return hit.hasHit ? { point: fromPage(hit.hitPointWorld), name: this.names.get(hit.body) } : null;
  }

  /** Let an object that is put at a box come to rest: its box then, and what is below it. */
  settle(id, box) {
    const body = this.hulls.get(id);
    const rest = this._fallen(body, box);
    this._put(body, rest);
    this.engine._step(STEP_S);
    return { box: rest, under: this._under(body, rest) };
  }

  _put({ transformNode }, { center, orientation }) {
    transformNode.position.set(...toPage(center));
    transformNode.rotationQuaternion.set(...turnToPage(orientation));
    transformNode.computeWorldMatrix(true);
  }

  _fallen(body, box) {
    const node = body.transformNode;
    this._put(body, { ...box, center: plus(box.center, at(0, 0, LIFT_M)) });
    this.engine._step(STEP_S);
    body.setMotionType(PhysicsMotionType.DYNAMIC);
    body.setMassProperties({ mass: MASS_KG });
    body.setLinearVelocity(Vector3.Zero());
    body.setAngularVelocity(Vector3.Zero());
    body.disablePreStep = true;
    body.disableSync = false;
    const [speed, spin] = [new Vector3(), new Vector3()];
    for (let step = 1; step * STEP_S < LONGEST_S; step++) {
      this.engine._step(STEP_S);
      body.getLinearVelocityToRef(speed);
      body.getAngularVelocityToRef(spin);
      if (step > FALLING && speed.length() < STILL_M_S && spin.length() < STILL_RAD_S) break;
    }
    const end = { ...box, center: fromPage(node.position), orientation: turnFromPage(node.rotationQuaternion) };
    this._hold(body);
    return hasCrept(box, end) ? box : end;
  }

  /** What is below the middle of a box, or below a place between it and a corner: {name, z}, or null. */
  _under(body, box) {
    const reach = Math.hypot(box.size.x, box.size.y, box.size.z) / 2 + PROBE_M;
    const places = [box.center, ...corners(box).map((c) => at((c.x + box.center.x) / 2, (c.y + box.center.y) / 2, box.center.z))];
    for (const place of places) {
      const hit = this._ray(place, DOWN, reach, CARRIES, body);
      if (hit) return { name: hit.name, z: hit.point.z };
    }
    return null;
  }
}

/** Whether it moved by so little that it may as well have stayed. */
function hasCrept(before, after) {
  const moved = Math.hypot(...["x", "y", "z"].map((k) => after.center[k] - before.center[k]));
  const [a, b] = [before.orientation, after.orientation];
  const same = Math.abs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z);
  return moved < CREEP_M && 2 * Math.acos(Math.min(1, same)) < CREEP_RAD;
}
