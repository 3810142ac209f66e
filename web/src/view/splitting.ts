// Cuts large triangles into smaller ones, so that light at their corners shows shades within.

import { BufferAttribute, BufferGeometry } from "three";

/** Corners with all that is known of each in one row of numbers; grows. */
class Corners {
  count: number;
  private rows: Float64Array;
  readonly width: number;
  private readonly names: readonly string[];
  private readonly sizes: readonly number[];
  /** Where the place stands in a row. */
  private readonly place: number;
  /** Edges that were cut: of each corner the last one to a later corner, and of each edge the one before. */
  private readonly last: number[] = [];
  private readonly before: number[] = [];
  private readonly other: number[] = [];
  private readonly cut: number[] = [];

  constructor(geometry: BufferGeometry) {
    this.names = Object.keys(geometry.attributes);
    const own = this.names.map((name) => geometry.getAttribute(name) as BufferAttribute);
    this.sizes = own.map(({ itemSize }) => itemSize);
    this.width = this.sizes.reduce((sum, size) => sum + size, 0);
    this.place = this.from(this.names.indexOf("position"));
    this.count = geometry.getAttribute("position").count;
    this.rows = new Float64Array(this.count * this.width * 2);
    own.forEach(({ array, itemSize }, n) => {
      const from = this.from(n);
      for (let i = 0; i < this.count; i++) {
        for (let k = 0; k < itemSize; k++) this.rows[i * this.width + from + k] = array[i * itemSize + k] as number;
      }
    });
    for (let i = 0; i < this.count; i++) this.last.push(-1);
  }

  /** Where an attribute begins in a row. */
  private from(n: number): number {
    return this.sizes.slice(0, n).reduce((sum, size) => sum + size, 0);
  }

  /** How far two corners are apart, squared. */
  far(a: number, b: number): number {
    const { rows } = this;
    const i = a * this.width + this.place;
    const j = b * this.width + this.place;
    const x = (rows[i] as number) - (rows[j] as number);
    const y = (rows[i + 1] as number) - (rows[j + 1] as number);
    const z = (rows[i + 2] as number) - (rows[j + 2] as number);
    return x * x + y * y + z * z;
  }

  /** The corner in the middle between two. */
  middle(a: number, b: number): number {
    const low = Math.min(a, b);
    const high = Math.max(a, b);
    // An edge has few that begin where it does: they are looked through one by one.
    for (let edge = this.last[low] as number; edge >= 0; edge = this.before[edge] as number) {
      if (this.other[edge] === high) return this.cut[edge] as number;
    }
    const { width } = this;
    if ((this.count + 1) * width > this.rows.length) this.grow();
    const { rows } = this;
    for (let k = 0; k < width; k++) {
      rows[this.count * width + k] = ((rows[a * width + k] as number) + (rows[b * width + k] as number)) / 2;
    }
    this.before.push(this.last[low] as number);
    this.other.push(high);
    this.cut.push(this.count);
    this.last[low] = this.cut.length - 1;
    this.last.push(-1);
    return this.count++;
  }

  private grow(): void {
    const rows = new Float64Array(this.rows.length * 2);
    rows.set(this.rows);
    this.rows = rows;
  }

  geometry(index: number[]): BufferGeometry {
    const out = new BufferGeometry();
    this.names.forEach((name, n) => {
      const [from, size] = [this.from(n), this.sizes[n] as number];
      const values = new Float32Array(this.count * size);
      for (let i = 0; i < this.count; i++) {
        for (let k = 0; k < size; k++) values[i * size + k] = this.rows[i * this.width + from + k] as number;
      }
      out.setAttribute(name, new BufferAttribute(values, size));
    });
    out.setIndex(index);
    return out;
  }
}

/** The same surface, with no edge longer than `most` metres. Edges that meet are cut alike: no cracks. */
export function split(geometry: BufferGeometry, most: number): BufferGeometry {
  const index = geometry.getIndex();
  if (!index || !geometry.hasAttribute("position")) return geometry;
  const corners = new Corners(geometry);
  const limit = most * most;
  const open = Array.from(index.array);
  const done: number[] = [];
  while (open.length) {
    const c = open.pop() as number;
    const b = open.pop() as number;
    const a = open.pop() as number;
    const ab = corners.far(a, b);
    const bc = corners.far(b, c);
    const ca = corners.far(c, a);
    const longest = Math.max(ab, bc, ca);
    if (longest <= limit) {
      done.push(a, b, c);
    } else if (longest === ab) {
      const middle = corners.middle(a, b);
      open.push(a, middle, c, middle, b, c);
    } else if (longest === bc) {
      const middle = corners.middle(b, c);
      open.push(b, middle, a, middle, c, a);
    } else {
      const middle = corners.middle(c, a);
      open.push(c, middle, b, middle, a, b);
    }
  }
  return done.length === index.count ? geometry : corners.geometry(done);
}
