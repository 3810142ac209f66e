// Points, rotations, boxes and upright prisms in ADAMO's frame: right-handed, metres, Z up.

export const at = (x, y, z) => ({ x, y, z });
export const minus = (a, b) => at(a.x - b.x, a.y - b.y, a.z - b.z);
export const plus = (a, b) => at(a.x + b.x, a.y + b.y, a.z + b.z);
export const times = (a, factor) => at(a.x * factor, a.y * factor, a.z * factor);
export const flatDistance = (a, b) => Math.hypot(a.x - b.x, a.y - b.y);
export const distance = (a, b) => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);

/** The same angle in (-pi, pi]. */
export function wrapAngle(angle) {
  const turned = (Math.PI - angle) % (2 * Math.PI);
  return Math.PI - (turned < 0 ? turned + 2 * Math.PI : turned);
}

/** A unit vector of a heading and an elevation, radians. */
export function direction(yaw, pitch) {
  return at(Math.cos(yaw) * Math.cos(pitch), Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch));
}

/** A vector turned by a unit quaternion. */
export function turned({ w, x, y, z }, v) {
  const tx = 2 * (y * v.z - z * v.y);
  const ty = 2 * (z * v.x - x * v.z);
  const tz = 2 * (x * v.y - y * v.x);
  return at(
    v.x + w * tx + y * tz - z * ty,
    v.y + w * ty + z * tx - x * tz,
    v.z + w * tz + x * ty - y * tx,
  );
}

/** The eight corners of a box. */
export function corners(box) {
  const found = [];
  for (const i of [-0.5, 0.5])
    for (const j of [-0.5, 0.5])
      for (const k of [-0.5, 0.5]) {
        const local = at(i * box.size.x, j * box.size.y, k * box.size.z);
        found.push(plus(box.center, turned(box.orientation, local)));
      }
  return found;
}

/** Heading of a rotation's X axis. */
export function yawOf({ w, x, y, z }) {
  return Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

/** The upright prism that holds a box, aligned with its heading. */
export function solidAround(box) {
  const yaw = yawOf(box.orientation);
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  const solid = {
    x: box.center.x, y: box.center.y, half_x: 0, half_y: 0, yaw_rad: yaw,
    z_min: Infinity, z_max: -Infinity,
  };
  for (const corner of corners(box)) {
    const [dx, dy] = [corner.x - box.center.x, corner.y - box.center.y];
    solid.half_x = Math.max(solid.half_x, Math.abs(dx * cos + dy * sin));
    solid.half_y = Math.max(solid.half_y, Math.abs(dy * cos - dx * sin));
    solid.z_min = Math.min(solid.z_min, corner.z);
    solid.z_max = Math.max(solid.z_max, corner.z);
  }
  return solid;
}

export const radiusOf = (solid) => Math.hypot(solid.half_x, solid.half_y);

/** Whether the height ranges share more than 2 mm. */
export function overlapsHeight(solid, low, high) {
  return solid.z_min < high - 0.002 && solid.z_max > low + 0.002;
}

/** Horizontal distance of a point from a prism; 0 inside. */
export function distanceTo(solid, x, y) {
  const [cos, sin] = [Math.cos(solid.yaw_rad), Math.sin(solid.yaw_rad)];
  const [dx, dy] = [x - solid.x, y - solid.y];
  const along = Math.max(Math.abs(dx * cos + dy * sin) - solid.half_x, 0);
  const across = Math.max(Math.abs(dy * cos - dx * sin) - solid.half_y, 0);
  return Math.hypot(along, across);
}

/** Lower bound of the gap between two prisms seen from above, the first put at (x, y); negative if they overlap. */
export function gap(shape, x, y, other) {
  const turn = shape.yaw_rad - other.yaw_rad;
  const [cos, sin] = [Math.abs(Math.cos(turn)), Math.abs(Math.sin(turn))];
  const [dx, dy] = [x - other.x, y - other.y];
  let widest = -Infinity;
  for (const [mine, theirs, yaw] of [[shape, other, shape.yaw_rad], [other, shape, other.yaw_rad]]) {
    const along = Math.abs(dx * Math.cos(yaw) + dy * Math.sin(yaw));
    const across = Math.abs(dy * Math.cos(yaw) - dx * Math.sin(yaw));
    widest = Math.max(
      widest,
      along - mine.half_x - (cos * theirs.half_x + sin * theirs.half_y),
      across - mine.half_y - (sin * theirs.half_x + cos * theirs.half_y),
    );
  }
  return widest;
}

/** Whether a straight line passes through a prism, not counting a skin of 1 cm. */
export function blocks(solid, start, end) {
  const [cos, sin] = [Math.cos(solid.yaw_rad), Math.sin(solid.yaw_rad)];
  const local = (p) => {
    const [dx, dy] = [p.x - solid.x, p.y - solid.y];
    return [dx * cos + dy * sin, dy * cos - dx * sin, p.z - (solid.z_min + solid.z_max) / 2];
  };
  const half = [solid.half_x, solid.half_y, (solid.z_max - solid.z_min) / 2].map((h) => h - 0.01);
  if (half.some((h) => h <= 0)) return false;
  const [a, b] = [local(start), local(end)];
  let [first, last] = [-Infinity, Infinity];
  for (const i of [0, 1, 2]) {
    const along = Math.abs(b[i] - a[i]) < 1e-9 ? 1e-9 : b[i] - a[i];
    const [enter, leave] = [(-half[i] - a[i]) / along, (half[i] - a[i]) / along];
    first = Math.max(first, Math.min(enter, leave));
    last = Math.min(last, Math.max(enter, leave));
  }
  return first < last && first < 1 && last > 0;
}
