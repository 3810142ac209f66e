// What the body does: look, walk, pick and drop, with ADAMO's codes for what it corrects and refuses.

import { at, blocks, flatDistance, radiusOf, solidAround } from "./geometry.js";
import { Floor, lengthOf } from "./floor.js";
import { freeSpots, spread } from "./placing.js";
import { facing, handCentre, walked } from "./stance.js";

const AS_ASKED_M = 0.05;
const REACH_MARGIN_M = 0.02;
const SHOULDERS_M = [1.35, 0.7];
const OVERHEAD_M = 1.75;
const MOST_SPOTS = 60;

const report = (outcome, code, more = {}) => ({ outcome, code, walked_m: 0, ...more });

export class BodyOf {
  /**
   * A body in a world.
   * @param world Knows what is where; see world.js.
   * @param settle Lets an object that was put at a box come to rest: (id, box) to the box, and what carries it.
   */
  constructor(world, settle) {
    this.world = world;
    this.settle = settle;
    this.ways = null;
  }

  look(point) {
    const { stance, exact } = facing(this.world.stance, point, this.world.info);
    this._stand(stance);
    return exact
      ? report("done", "ok", { point: stance.gaze })
      : report("corrected", "gaze_limited", { point: stance.gaze });
  }

  walk(point) {
    const path = this._ways().toNearest(point);
    this._walk(path);
    const end = path.at(-1);
    const more = { point: end, walked_m: lengthOf(path) };
    return flatDistance(end, point) <= AS_ASKED_M
      ? report("done", "ok", more)
      : report("corrected", "stopped_short", more);
  }

  async pick(id) {
    const { world } = this;
    if (world.stance.held !== null) return report("refused", "hand_full");
    const target = world.object(id).box.center;
    const path = this._wayTo(target, target.z < OVERHEAD_M ? world.info.radius_m : 0);
    if (path === null) return this._unreachable(target);
    this._walk(path);
    const carried = world.objects.filter((item) => item.support === `object ${id}`);
    world.object(id).support = null;
    this._stand({ ...facing(world.stance, target, world.info).stance, held: id });
    for (const item of carried) await this._rest(item.id, item.box);
    const length = lengthOf(path);
    return report("done", length > 0 ? "repositioned" : "ok", { point: target, walked_m: length });
  }

  async drop(point) {
    const { world } = this;
    const { held } = world.stance;
    if (held === null) return report("refused", "hand_empty");
    const shape = solidAround(world.object(held).box);
    const spots = freeSpots(point, shape, world.surfaces, this._obstacles(held), world.info.correction_m);
    if (!spots.length) return report("refused", "no_free_spot");
    const chosen = this._reachable(spots, radiusOf(shape));
    if (chosen === null) return this._unreachable(point);
    this._walk(chosen.path);
    this._stand({ ...facing(world.stance, chosen.spot.center, world.info).stance, held: null });
    await this._rest(held, { ...world.object(held).box, center: chosen.spot.center });
    const { box, support } = world.object(held);
    const more = { point: box.center, support, walked_m: lengthOf(chosen.path) };
    const isAsAsked = chosen.spot.distance <= AS_ASKED_M && flatDistance(box.center, point) <= AS_ASKED_M;
    if (!isAsAsked) return report("corrected", "placed_elsewhere", more);
    return report("done", more.walked_m > 0 ? "repositioned" : "ok", more);
  }

  async _rest(id, box) {
    const rest = await this.settle(id, box);
    Object.assign(this.world.object(id), rest);
    this.changed();
  }

  /** Take a stance, and bring what is held to the hand. */
  _stand(stance) {
    const { world } = this;
    world.stance = stance;
    if (stance.held !== null) {
      const item = world.object(stance.held);
      item.box = { ...item.box, center: handCentre(stance, item.box, world.scene) };
    }
    this.changed();
  }

  /** The world is otherwise than before. */
  changed() {
    this.ways = null;
  }

  _walk(path) {
    if (path.length > 1) this._stand(walked(this.world.stance, path, this.world.info));
  }

  _obstacles(excluded) {
    const things = this.world.objects.filter((item) => item.id !== excluded);
    return [...this.world.solids, ...things.map((item) => solidAround(item.box))];
  }

  _ways() {
    if (this.ways === null) {
      const { world } = this;
      const low = this._obstacles(world.stance.held).filter((s, i) => i < world.solids.length || s.z_min < 0.3);
      this.ways = new Floor(world.scene, low, world.info.radius_m).waysFrom(world.stance.position);
    }
    return this.ways;
  }

  _canReach(place, target) {
    if (target.z > this.world.info.reach_top_m) return false;
    return SHOULDERS_M.some((height) => {
      const shoulder = at(place.x, place.y, height);
      return !this.world.solids.some((solid) => blocks(solid, shoulder, target));
    });
  }

  /** The shortest way to a place from which a target can be handled; stay if this is one. */
  _wayTo(target, keepOff) {
    const here = this.world.stance.position;
    const far = flatDistance(here, target);
    const { reach_m } = this.world.info;
    if (far >= keepOff && far <= reach_m && this._canReach(here, target)) return [here];
    const accept = (place) => this._canReach(place, target);
    return this._ways().toStandingPlace(target, reach_m - REACH_MARGIN_M, keepOff, accept);
  }

  _reachable(spots, radius) {
    let count = 0;
    for (const spot of spread(spots)) {
      if (count++ >= MOST_SPOTS) return null;
      const path = this._wayTo(spot.center, this.world.info.radius_m + radius + 0.01);
      if (path !== null) return { spot, path };
    }
    return null;
  }

  _unreachable(target) {
    return report("refused", "unreachable", { point: this._ways().toNearest(target).at(-1) });
  }
}
