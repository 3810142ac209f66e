// Cuts large triangles into smaller ones, so that light at their corners shows shades within.

import { BufferAttribute, BufferGeometry } from "three";

/** The same surface, with no edge longer than `most` metres. Edges that meet are cut alike: no cracks. */
export function split(geometry: BufferGeometry, most: number): BufferGeometry {
  const index = geometry.getIndex();
  const position = geometry.getAttribute("position");
  if (!index || !position) return geometry;
  const names = Object.keys(geometry.attributes);
  const values = names.map((name) => Array.from((geometry.getAttribute(name) as BufferAttribute).array));
  const sizes = names.map((name) => geometry.getAttribute(name).itemSize);
  const places = values[names.indexOf("position")] as number[];
  const far = (a: number, b: number): number => {
    const x = (places[a * 3] as number) - (places[b * 3] as number);
    const y = (places[a * 3 + 1] as number) - (places[b * 3 + 1] as number);
    const z = (places[a * 3 + 2] as number) - (places[b * 3 + 2] as number);
    return x * x + y * y + z * z;
  };
  let count = position.count;
  // Of each corner, its edges to later ones: few, so that they are looked through one by one.
  const edges: { other: number; middle: number }[][] = Array.from({ length: count }, () => []);
  const middle = (a: number, b: number): number => {
    const [low, high] = a < b ? [a, b] : [b, a];
    const own = edges[low] as { other: number; middle: number }[];
    for (const edge of own) if (edge.other === high) return edge.middle;
    values.forEach((all, n) => {
      const size = sizes[n] as number;
      for (let k = 0; k < size; k++) all.push(((all[a * size + k] as number) + (all[b * size + k] as number)) / 2);
    });
    own.push({ other: high, middle: count });
    edges.push([]);
    return count++;
  };
  const limit = most * most;
  const open = Array.from(index.array);
  const done: number[] = [];
  while (open.length) {
    const c = open.pop() as number;
    const b = open.pop() as number;
    const a = open.pop() as number;
    const [ab, bc, ca] = [far(a, b), far(b, c), far(c, a)];
    const longest = Math.max(ab, bc, ca);
    if (longest <= limit) done.push(a, b, c);
    else if (longest === ab) open.push(a, middle(a, b), c, middle(a, b), b, c);
    else if (longest === bc) open.push(b, middle(b, c), a, middle(b, c), c, a);
    else open.push(c, middle(c, a), b, middle(c, a), a, b);
  }
  if (done.length === index.count) return geometry;
  const out = new BufferGeometry();
  names.forEach((name, n) => out.setAttribute(name, new BufferAttribute(new Float32Array(values[n] as number[]), sizes[n] as number)));
  out.setIndex(done);
  return out;
}
