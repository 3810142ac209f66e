// Numbers of a mesh as they are meant, whatever they are packed in.

import { type BufferAttribute, InterleavedBufferAttribute, type Matrix3, type Matrix4, type TypedArray } from "three";

export type Attribute = BufferAttribute | InterleavedBufferAttribute;

type Numbers = Float32Array | Float64Array;

/** What stands for 1 in packed numbers. */
const ONE = new Map<unknown, number>([
  [Int8Array, 127],
  [Uint8Array, 255],
  [Int16Array, 32_767],
  [Uint16Array, 65_535],
]);

/** All numbers of an attribute, one corner after the other; into a list from some place on, if one is given. */
export function floats<Out extends Numbers = Float32Array>(
  attribute: Attribute,
  out = new Float32Array(attribute.count * attribute.itemSize) as Out,
  at = 0,
): Out {
  const { count, itemSize, normalized } = attribute;
  const array = attribute.array as TypedArray;
  const end = at + count * itemSize;
  if (attribute instanceof InterleavedBufferAttribute) {
    const { offset, data } = attribute;
    for (let i = 0, to = at; i < count; i++) {
      for (let k = 0; k < itemSize; k++) out[to++] = array[offset + i * data.stride + k] as number;
    }
  } else out.set(array, at);
  if (!normalized) return out;
  const one = ONE.get(array.constructor) ?? 1;
  for (let i = at; i < end; i++) {
    const value = (out[i] as number) / one;
    out[i] = value < -1 ? -1 : value;
  }
  return out;
}

/** Places where a matrix moves them; they may be written over. */
export function placed<Out extends Numbers>(places: Numbers, { elements: e }: Matrix4, out: Out): Out {
  const a = e[0], b = e[1], c = e[2], d = e[4], f = e[5], g = e[6], h = e[8], i = e[9], j = e[10], k = e[12], l = e[13], m = e[14];
  for (let at = 0; at < places.length; at += 3) {
    const x = places[at] as number;
    const y = places[at + 1] as number;
    const z = places[at + 2] as number;
    out[at] = a * x + d * y + h * z + k;
    out[at + 1] = b * x + f * y + i * z + l;
    out[at + 2] = c * x + g * y + j * z + m;
  }
  return out;
}

/** Ways as a matrix turns them, each as long as 1; they may be written over. */
export function turned<Out extends Numbers>(ways: Numbers, { elements: e }: Matrix3 | Matrix4, out: Out): Out {
  const row = e.length === 16 ? 4 : 3;
  const a = e[0] as number, b = e[1] as number, c = e[2] as number;
  const d = e[row] as number, f = e[row + 1] as number, g = e[row + 2] as number;
  const h = e[row * 2] as number, i = e[row * 2 + 1] as number, j = e[row * 2 + 2] as number;
  for (let at = 0; at < ways.length; at += 3) {
    const x = ways[at] as number;
    const y = ways[at + 1] as number;
    const z = ways[at + 2] as number;
    const u = a * x + d * y + h * z;
    const v = b * x + f * y + i * z;
    const w = c * x + g * y + j * z;
    const scale = 1 / (Math.sqrt(u * u + v * v + w * w) || 1);
    out[at] = u * scale;
    out[at + 1] = v * scale;
    out[at + 2] = w * scale;
  }
  return out;
}
