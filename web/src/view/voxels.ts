// The room in small cubes: which are filled tells cameras where not to be, and light where it is dim.

import { type Box3, type Mesh, Vector3 } from "three";
import { floats, placed } from "./floats.ts";

export const CELL_M = 0.1;

export class Voxels {
  readonly nx: number;
  readonly ny: number;
  readonly nz: number;
  readonly filled: Uint8Array;
  /** Above this nothing stands, metres. */
  top: number;

  /** The room's inside, in metres. */
  constructor(readonly box: Box3) {
    const size = box.getSize(new Vector3());
    this.nx = Math.max(1, Math.round(size.x / CELL_M));
    this.ny = Math.max(1, Math.round(size.y / CELL_M));
    this.nz = Math.max(1, Math.round(size.z / CELL_M));
    this.filled = new Uint8Array(this.nx * this.ny * this.nz);
    this.top = box.min.z;
  }

  index(x: number, y: number, z: number): number {
    const { min } = this.box;
    const i = Math.floor((x - min.x) / CELL_M);
    const j = Math.floor((y - min.y) / CELL_M);
    const k = Math.floor((z - min.z) / CELL_M);
    if (i < 0 || j < 0 || k < 0 || i >= this.nx || j >= this.ny || k >= this.nz) return -1;
    return i + this.nx * (j + this.ny * k);
  }

  isFilled(x: number, y: number, z: number): boolean {
    const index = this.index(x, y, z);
    return index >= 0 && this.filled[index] === 1;
  }

  /** Whether something is within half a cell of a point in any direction. */
  isNear(x: number, y: number, z: number, margin = CELL_M): boolean {
    if (this.isFilled(x, y, z)) return true;
    return (
      this.isFilled(x + margin, y, z) ||
      this.isFilled(x - margin, y, z) ||
      this.isFilled(x, y + margin, z) ||
      this.isFilled(x, y - margin, z) ||
      this.isFilled(x, y, z + margin) ||
      this.isFilled(x, y, z - margin)
    );
  }

  /** Fill what the triangles of a mesh pass through. */
  add(mesh: Mesh): void {
    mesh.updateWorldMatrix(true, false);
    const own = mesh.geometry.getAttribute("position");
    const corners = floats(own, new Float64Array(own.count * 3));
    const places = placed(corners, mesh.matrixWorld, corners);
    const index = mesh.geometry.getIndex()?.array;
    const count = index ? index.length : own.count;
    for (let i = 0; i + 2 < count; i += 3) {
      if (index) this.fillTriangle(places, (index[i] as number) * 3, (index[i + 1] as number) * 3, (index[i + 2] as number) * 3);
      else this.fillTriangle(places, i * 3, i * 3 + 3, i * 3 + 6);
    }
  }

  /** Corners are told by where they begin in the list of places. */
  private fillTriangle(places: Float64Array, a: number, b: number, c: number): void {
    const ax = places[a] as number, ay = places[a + 1] as number, az = places[a + 2] as number;
    const bx = places[b] as number, by = places[b + 1] as number, bz = places[b + 2] as number;
    const cx = places[c] as number, cy = places[c + 1] as number, cz = places[c + 2] as number;
    const longest = Math.max(apart(ax - bx, ay - by, az - bz), apart(bx - cx, by - cy, bz - cz), apart(cx - ax, cy - ay, cz - az));
    const steps = Math.min(200, Math.max(1, Math.ceil(longest / (CELL_M * 0.7))));
    const { filled, nx, ny, nz } = this;
    const { x: x0, y: y0, z: z0 } = this.box.min;
    for (let u = 0; u <= steps; u++) {
      const p = u / steps;
      for (let v = 0; v <= steps - u; v++) {
        const q = v / steps;
        const r = 1 - p - q;
        const z = az * p + bz * q + cz * r;
        const i = Math.floor((ax * p + bx * q + cx * r - x0) / CELL_M);
        const j = Math.floor((ay * p + by * q + cy * r - y0) / CELL_M);
        const k = Math.floor((z - z0) / CELL_M);
        if (i < 0 || j < 0 || k < 0 || i >= nx || j >= ny || k >= nz) continue;
        filled[i + nx * (j + ny * k)] = 1;
        if (z + CELL_M > this.top) this.top = z + CELL_M;
      }
    }
  }

  /** How far one sees from a point in a direction, at most `far`; what the point itself is in does not count. */
  free(from: Vector3, direction: Vector3, far: number): number {
    const step = CELL_M / 2;
    let outside = false;
    for (let s = 0; s <= far; s += step) {
      const near = this.isNear(from.x + direction.x * s, from.y + direction.y * s, from.z + direction.z * s, 0.08);
      if (!near) outside = true;
      else if (outside) return Math.max(0, s - step);
    }
    return far;
  }

  /** Floor plan of where a body of some radius can stand: 1 for each free cell, nx * ny. */
  standing(radius: number, top = 1.9): Uint8Array {
    const free = new Uint8Array(this.nx * this.ny).fill(1);
    const reach = Math.ceil(radius / CELL_M);
    const block = (i: number, j: number): void => {
      for (let dj = -reach; dj <= reach; dj++) {
        for (let di = -reach; di <= reach; di++) {
          const [x, y] = [i + di, j + dj];
          if (x < 0 || y < 0 || x >= this.nx || y >= this.ny) continue;
          if (Math.hypot(di, dj) * CELL_M <= radius) free[x + this.nx * y] = 0;
        }
      }
    };
    const layers = Math.min(this.nz, Math.round(top / CELL_M));
    for (let j = 0; j < this.ny; j++) {
      for (let i = 0; i < this.nx; i++) {
        const atWall = Math.min(i, j, this.nx - 1 - i, this.ny - 1 - j) + 0.5 < radius / CELL_M;
        if (atWall) free[i + this.nx * j] = 0;
        for (let k = 1; k < layers; k++) {
          if (this.filled[i + this.nx * (j + this.ny * k)]) {
            block(i, j);
            break;
          }
        }
      }
    }
    return free;
  }
}

const apart = (x: number, y: number, z: number): number => Math.sqrt(x * x + y * y + z * z);
