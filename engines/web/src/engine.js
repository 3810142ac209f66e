// Answers ADAMO's requests with a world, a stage and the physics of one scene.

import { BodyOf } from "./body.js";
import { shownIn } from "./ids.js";
import { aimed } from "./stance.js";
import { World } from "./world.js";

export const WIRE = 1;
export const FRAME = "right-handed, z up, metres";
const BODY = "agent";

export class PageEngine {
  /**
   * @param stage Draws; see stage.js.
   * @param fetchScene Gives scene.json and the address of its folder, by name.
   * @param physicsOf Makes the physics of a stage that has loaded the scene of a world.
   * @param shown Is called after everything that changed what the eyes see.
   */
  constructor(stage, fetchScene, physicsOf, shown = () => {}) {
    Object.assign(this, { stage, fetchScene, physicsOf, shown, world: null });
  }

  hello(name) {
    const abilities = { ids: true, closeup: true, snapshot: true, events: false, deterministic: true };
    return { wire: WIRE, engine: name, frame: FRAME, abilities };
  }

  /** The result of a request, and the binary messages that follow it. */
  async answer(method, asked) {
    if (!METHODS.has(method)) throw new Error(`there is no method ${method}.`);
    if (method !== "scene" && !this.world) throw new Error("ask for a scene first.");
    if ("body" in asked && asked.body !== BODY) throw new Error(`there is no body ${asked.body}.`);
    if (method === "capture") return this._capture(asked);
    return { result: (await this[`_${method}`](asked)) ?? {}, pictures: [] };
  }

  async _scene({ scene }) {
    const { told, base } = await this.fetchScene(scene);
    this.world = null;
    const world = new World(told);
    await this.stage.load(told, base);
    this.physics = await this.physicsOf(this.stage, world);
    this.body = new BodyOf(world, (id, box) => this._settled(id, box));
    this.world = world;
    this._follow();
    return world.sceneAnswer();
  }

  _settled(id, box) {
    this._follow();
    const { box: rest, under } = this.physics.settle(id, box);
    return { box: rest, support: this.world.supportOf(under) };
  }

  /** Stage and physics show what the world says. */
  _follow() {
    this.stage.show(this.world.objects);
    this.physics.follow(this.world.objects, this.world.stance.held);
  }

  _bodies() {
    return this.world.bodiesAnswer();
  }

  _reset() {
    this._set(() => this.world.reset());
  }

  _restore({ snapshot }) {
    this._set(() => this.world.restore(snapshot));
  }

  _set(change) {
    change();
    this.body.changed();
    this._follow();
    this.shown();
  }

  _state() {
    return this.world.state();
  }

  _snapshot() {
    return { snapshot: this.world.snapshot() };
  }

  _rays({ origin, directions }) {
    return { hits: this.physics.rays(origin, directions) };
  }

  _look({ point }) {
    return this._acted(this.body.look(point));
  }

  _walk({ point }) {
    return this._acted(this.body.walk(point));
  }

  _pick({ object_id }) {
    this.world.object(object_id);
    return this._acted(this.body.pick(object_id));
  }

  _drop({ point }) {
    return this._acted(this.body.drop(point));
  }

  async _acted(report) {
    const told = await report;
    this._follow();
    this.shown();
    return told;
  }

  _say({ text }) {
    this.world.said.push(text);
  }

  _apply() {
    throw new Error("nothing happens in this page but by its body.");
  }

  /** How the eyes look: straight at the gaze, or closer at a point. */
  view(aim = null) {
    const body = this.world.body();
    const { yaw, pitch } = aimed(body.eyes, aim?.point ?? body.gaze, body.heading_rad);
    const fov_y_rad = aim?.fov_y_rad ?? this.world.info.fov_y_rad;
    return { position: body.eyes, yaw_rad: yaw, pitch_rad: pitch, fov_y_rad };
  }

  async _capture({ width_px: width, height_px: height, aim }) {
    const camera = this.view(aim);
    this.stage.aim(camera);
    const picture = await this.stage.colours(width, height);
    const layers = await this.stage.ids(width, height);
    const objects = shownIn(layers).map((id) => ({ id, box: this.world.object(id).box }));
    const body = this.world.body();
    const result = { camera, body, objects, colour: "jpeg", ids: "int16", layers: layers.length };
    return { result, pictures: [picture, ...layers] };
  }
}

const METHODS = new Set([
  "scene", "bodies", "reset", "state", "capture", "rays", "look", "walk", "pick", "drop", "say", "snapshot", "restore", "apply",
]);
