// Between two samples: rotations on the shortest way, places on the straight one.

import type { Placed } from "../protocol.ts";

/** The same angle in (-pi, pi]. */
export function wrap(angle: number): number {
  const turned = (Math.PI - angle) % (2 * Math.PI);
  return Math.PI - (turned < 0 ? turned + 2 * Math.PI : turned);
}

/** Write a rotation between two unit quaternions x, y, z, w, which start at `from` in their lists. */
function slerp(
  a: ArrayLike<number>,
  b: ArrayLike<number>,
  from: number,
  share: number,
  out: { [index: number]: number },
): void {
  let cos = 0;
  for (let i = from; i < from + 4; i++) cos += (a[i] ?? 0) * (b[i] ?? 0);
  const sign = cos < 0 ? -1 : 1;
  cos = Math.min(1, Math.abs(cos));
  let first = 1 - share;
  let second = share;
  if (cos < 0.9995) {
    const angle = Math.acos(cos);
    const sin = Math.sin(angle);
    first = Math.sin(first * angle) / sin;
    second = Math.sin(second * angle) / sin;
  }
  let length = 0;
  for (let i = from; i < from + 4; i++) {
    const value = (a[i] ?? 0) * first + (b[i] ?? 0) * second * sign;
    out[i] = value;
    length += value * value;
  }
  const scale = length > 0 ? 1 / Math.sqrt(length) : 1;
  for (let i = from; i < from + 4; i++) out[i] = (out[i] ?? 0) * scale;
}

/** All rotations of a pose between two samples. */
export function blendQuaternions(a: readonly number[], b: readonly number[], share: number): Float32Array {
  const out = new Float32Array(a.length);
  if (share <= 0 || b.length !== a.length) out.set(a);
  else if (share >= 1) out.set(b);
  else for (let i = 0; i + 3 < a.length; i += 4) slerp(a, b, i, share, out);
  return out;
}

/** A thing between two samples. */
export function blendPlaced(a: Placed, b: Placed, share: number): Placed {
  const out: Placed = [...a];
  slerp(a, b, 3, share, out);
  for (let i = 0; i < 3; i++) out[i] = (a[i] as number) + ((b[i] as number) - (a[i] as number)) * share;
  return out;
}
