// What is where: the exported scene, the objects and the body in it, and saved states as JSON.

import { at } from "./geometry.js";
import { eyes } from "./stance.js";

const FORMAT = 1;
const BODY = ["figure", "radius_m", "eye_height_m", "fov_y_rad", "reach_m", "reach_top_m", "correction_m"];
const copied = (value) => JSON.parse(JSON.stringify(value));
const only = (value, names) => Object.fromEntries(names.map((name) => [name, value[name]]));

export class World {
  /** @param told scene.json, as `adamo-vh scenes export` writes it. */
  constructor(told) {
    if (told.format !== FORMAT)
      throw new Error(`the scene is of format ${told.format}, and this page reads ${FORMAT}; export it anew.`);
    this.told = told;
    this.scene = only(told.scene, ["name", "x_min", "y_min", "x_max", "y_max", "height_m", "areas", "variation"]);
    this.info = told.body;
    this.solids = told.furniture.flatMap((piece) => piece.solids);
    this.surfaces = [floorOf(told.scene), ...told.furniture.flatMap((piece) => piece.surfaces)];
    this.reset();
  }

  reset() {
    this.objects = copied(this.told.objects).map(({ mesh, ...item }) => item);
    const { position, heading_rad: heading, gaze } = copied(this.told.start);
    this.stance = { position, heading, gaze, held: null };
    this.said = [];
  }

  object(id) {
    const found = this.objects.find((item) => item.id === id);
    if (!found) throw new Error(`there is no object ${id}.`);
    return found;
  }

  body() {
    const { position, heading, gaze, held } = this.stance;
    const held_box = held === null ? null : this.object(held).box;
    return { position, heading_rad: heading, gaze, eyes: eyes(this.stance, this.info), held, held_box };
  }

  state() {
    const objects = this.objects.map((item) => ({ ...item, held: item.id === this.stance.held }));
    return { objects, bodies: { agent: this.body() } };
  }

  sceneAnswer() {
    const object_names = Object.fromEntries(this.told.objects.map((item) => [item.id, item.class_name]));
    const outline = ["name", "points", "bottom_m", "top_m", "surfaces"];
    return { scene: this.scene, object_names, furniture: this.told.furniture.map((piece) => only(piece, outline)) };
  }

  bodiesAnswer() {
    return { bodies: { agent: only(this.info, BODY) } };
  }

  /** Every prism that carries things, the floor among them: {name, solid}. */
  carriers() {
    const { center, half_x, half_y } = this.surfaces[0];
    const floor = { x: center.x, y: center.y, half_x, half_y, yaw_rad: 0, z_min: -1, z_max: 0 };
    const pieces = this.told.furniture.flatMap(({ name, solids }) => solids.map((solid) => ({ name, solid })));
    return [{ name: "floor", solid: floor }, ...pieces];
  }

  /** Name of what is below something: furniture with several levels says which one. */
  supportOf(under) {
    if (under === null) return null;
    const levels = this.surfaces.filter((s) => s.support.split("/")[0] === under.name);
    const away = (s) => Math.abs(s.center.z - under.z);
    return levels.length ? levels.reduce((a, b) => (away(b) < away(a) ? b : a)).support : under.name;
  }

  /** Everything that decides what happens next, as a text. */
  snapshot() {
    const objects = this.objects.map(({ id, box, support }) => ({ id, box, support }));
    return JSON.stringify({ format: FORMAT, scene: this.scene.name, stance: this.stance, said: this.said, objects });
  }

  /** Go back to a snapshot; one that is damaged changes nothing. */
  restore(text) {
    let kept;
    try {
      kept = JSON.parse(text);
    } catch {
      throw new Error("the snapshot is damaged: it is no JSON.");
    }
    const ids = (items) => JSON.stringify(items.map((item) => item?.id));
    if (kept?.format !== FORMAT || kept.scene !== this.scene.name || !Array.isArray(kept.objects))
      throw new Error(`the snapshot is none of scene ${this.scene.name}.`);
    const whole = ids(kept.objects) === ids(this.objects) && kept.objects.every(isPlaced) && isStance(kept.stance);
    if (!whole || !(kept.stance.held === null || this.objects.some((item) => item.id === kept.stance.held)))
      throw new Error("the snapshot is damaged: something in it is missing.");
    this.objects = this.objects.map((item, i) => ({ ...item, box: kept.objects[i].box, support: kept.objects[i].support }));
    this.stance = kept.stance;
    this.said = kept.said ?? [];
  }
}

const isPoint = (p) => [p?.x, p?.y, p?.z].every(Number.isFinite);
const isPlaced = ({ box }) => isPoint(box?.center) && isPoint(box?.size) && isPoint(box?.orientation) && Number.isFinite(box.orientation.w);
const isStance = (s) => isPoint(s?.position) && isPoint(s?.gaze) && Number.isFinite(s?.heading);

function floorOf(room) {
  const center = at((room.x_min + room.x_max) / 2, (room.y_min + room.y_max) / 2, 0);
  const [half_x, half_y] = [(room.x_max - room.x_min) / 2, (room.y_max - room.y_min) / 2];
  return { support: "floor", center, half_x, half_y, yaw_rad: 0 };
}
