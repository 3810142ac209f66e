// Free spots: where an object can be put down, nearest to a wished point.

import { at, flatDistance, gap, overlapsHeight, radiusOf } from "./geometry.js";

const CLEARANCE_M = 0.01;
const EDGE_M = 0.005;
const STEP_M = 0.02;

/** All spots for an object, nearest to the wish first: {support, center, distance}. */
export function freeSpots(wish, shape, surfaces, obstacles, correction) {
  const height = shape.z_max - shape.z_min;
  const within = correction + radiusOf(shape) + CLEARANCE_M;
  const near = obstacles.filter((o) => Math.hypot(o.x - wish.x, o.y - wish.y) < within + radiusOf(o));
  const spots = [];
  for (const surface of surfaces) {
    const top = surface.center.z;
    const lift = wish.z - top;
    // A wish between the surface and the top of the placed object means this surface.
    const miss = Math.max(-lift, lift - height, 0);
    if (miss > correction) continue;
    const beside = near.filter((o) => overlapsHeight(o, top, top + height));
    for (const [dx, dy, flat] of offsets(correction)) {
      const distance = Math.hypot(flat, miss);
      if (distance > correction) continue;
      const [x, y] = [wish.x + dx, wish.y + dy];
      if (!isCarried(x, y, shape, surface)) continue;
      if (beside.some((o) => gap(shape, x, y, o) < CLEARANCE_M)) continue;
      spots.push({ support: surface.support, center: at(x, y, top + height / 2), distance });
    }
  }
  return spots.sort((a, b) => a.distance - b.distance);
}

/** Spots in order without those close to one already given, for costly further checks. */
export function* spread(spots, apart = 0.06) {
  const given = [];
  for (const spot of spots) {
    if (given.some((s) => s.support === spot.support && flatDistance(s.center, spot.center) < apart)) continue;
    given.push(spot);
    yield spot;
  }
}

const known = new Map();

function offsets(correction) {
  if (!known.has(correction)) {
    const found = [];
    const count = Math.round(correction / STEP_M);
    for (let i = -count; i <= count; i++)
      for (let j = -count; j <= count; j++) {
        const flat = Math.hypot(i * STEP_M, j * STEP_M);
        if (flat <= correction) found.push([i * STEP_M, j * STEP_M, flat]);
      }
    known.set(correction, found.sort((a, b) => a[2] - b[2]));
  }
  return known.get(correction);
}

/** Whether the whole footprint lies on the surface. */
function isCarried(x, y, shape, surface) {
  const [cos, sin] = [Math.cos(surface.yaw_rad), Math.sin(surface.yaw_rad)];
  const turn = shape.yaw_rad - surface.yaw_rad;
  const [c, s] = [Math.abs(Math.cos(turn)), Math.abs(Math.sin(turn))];
  const [dx, dy] = [x - surface.center.x, y - surface.center.y];
  return (
    Math.abs(dx * cos + dy * sin) + c * shape.half_x + s * shape.half_y <= surface.half_x - EDGE_M &&
    Math.abs(dy * cos - dx * sin) + s * shape.half_x + c * shape.half_y <= surface.half_y - EDGE_M
  );
}
