// How the body stands: where, which way it faces, what it looks at, and where its hand is.

import { at, corners, direction, distance, minus, plus, times, wrapAngle } from "./geometry.js";

const EYE_FORWARD_M = 0.08;
const HAND = at(0.38, -0.18, 1.0);
/** What a hand takes down is held at least this far above the floor, metres. */
const LOWEST_M = 0.02;

const inWorld = (stance, local) => {
  const [cos, sin] = [Math.cos(stance.heading), Math.sin(stance.heading)];
  return at(
    stance.position.x + cos * local.x - sin * local.y,
    stance.position.y + sin * local.x + cos * local.y,
    stance.position.z + local.z,
  );
};

export const eyes = (stance, info) => inWorld(stance, at(EYE_FORWARD_M, 0, info.eye_height_m));

/** Turn to a point, with the body and then the eyes: the new stance, and whether the neck could turn so far. */
export function facing(stance, point, info) {
  const offset = minus(point, stance.position);
  const flat = Math.hypot(offset.x, offset.y);
  const heading = wrapAngle(flat > 0.05 ? Math.atan2(offset.y, offset.x) : stance.heading);
  const turned = { ...stance, heading };
  const from = eyes(turned, info);
  // A point between axis and eyes lies behind the eyes: they can only look down at it.
  const ahead = flat > EYE_FORWARD_M ? Math.hypot(point.x - from.x, point.y - from.y) : 0;
  const pitch = Math.atan2(point.z - from.z, ahead);
  if (Math.abs(pitch) <= info.max_pitch_rad) return { stance: { ...turned, gaze: point }, exact: true };
  const far = Math.max(0.3, distance(point, from));
  const limit = Math.sign(pitch) * info.max_pitch_rad;
  const gaze = plus(from, times(direction(heading, limit), far));
  return { stance: { ...turned, gaze }, exact: false };
}

/** Stand at the end of a way, looking straight ahead. */
export function walked(stance, points, info) {
  const [before, end] = points.slice(-2);
  const heading = wrapAngle(Math.atan2(end.y - before.y, end.x - before.x));
  const moved = { ...stance, position: end, heading };
  return { ...moved, gaze: plus(eyes(moved, info), direction(heading, 0)) };
}

/** Where the hand holds a box: before the body, and never in a wall or in the floor. */
export function handCentre(stance, box, room) {
  const center = inWorld(stance, HAND);
  const all = corners({ ...box, center });
  const inside = (name, low, high) => {
    const least = Math.min(...all.map((c) => c[name]));
    const most = Math.max(...all.map((c) => c[name]));
    return center[name] + Math.max(low - least, 0) - Math.max(most - high, 0);
  };
  return at(
    inside("x", room.x_min, room.x_max),
    inside("y", room.y_min, room.y_max),
    inside("z", LOWEST_M, room.height_m),
  );
}

/** The heading and elevation of a look from the eyes to a point. */
export function aimed(from, point, heading) {
  const line = minus(point, from);
  const flat = Math.hypot(line.x, line.y);
  return { yaw: flat > 1e-6 ? Math.atan2(line.y, line.x) : heading, pitch: Math.atan2(line.z, flat) };
}
