// Numbers of a mesh as they are meant, whatever they are packed in.

import { type BufferAttribute, InterleavedBufferAttribute, type TypedArray } from "three";

export type Attribute = BufferAttribute | InterleavedBufferAttribute;

/** What stands for 1 in packed numbers. */
const ONE = new Map<unknown, number>([
  [Int8Array, 127],
  [Uint8Array, 255],
  [Int16Array, 32_767],
  [Uint16Array, 65_535],
]);

/** All numbers of an attribute, one corner after the other; into a list from some place on, if one is given. */
export function floats(attribute: Attribute, out = new Float32Array(attribute.count * attribute.itemSize), at = 0): Float32Array {
  const { count, itemSize, normalized } = attribute;
  const array = attribute.array as TypedArray;
  const isWoven = attribute instanceof InterleavedBufferAttribute;
  const [step, first] = isWoven ? [attribute.data.stride, attribute.offset] : [itemSize, 0];
  const one = normalized ? (ONE.get(array.constructor) ?? 1) : 1;
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < itemSize; k++) {
      const value = (array[first + i * step + k] as number) / one;
      out[at++] = normalized && value < -1 ? -1 : value;
    }
  }
  return out;
}
