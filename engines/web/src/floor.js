// Where the body can stand, and the shortest way there: a 5 cm grid, Dijkstra, and string pulling.

import { at, distanceTo, overlapsHeight } from "./geometry.js";

const CELL_M = 0.05;
const BODY_HEIGHT_M = 1.75;

export const lengthOf = (points) =>
  points.slice(1).reduce((sum, p, i) => sum + Math.hypot(p.x - points[i].x, p.y - points[i].y), 0);

export class Floor {
  /** Map a room, with everything in it that the body must not touch. */
  constructor(room, solids, radius) {
    this.room = room;
    this.radius = radius;
    this.solids = solids.filter((solid) => overlapsHeight(solid, 0, BODY_HEIGHT_M));
    this.columns = Math.ceil((room.x_max - room.x_min - CELL_M / 2) / CELL_M - 1e-9);
    this.rows = Math.ceil((room.y_max - room.y_min - CELL_M / 2) / CELL_M - 1e-9);
    this.free = new Uint8Array(this.columns * this.rows);
    for (let cell = 0; cell < this.free.length; cell++) {
      const { x, y } = this.centre(cell);
      this.free[cell] = this.clearance(x, y) >= radius ? 1 : 0;
    }
  }

  centre(cell) {
    const column = Math.floor(cell / this.rows);
    const row = cell % this.rows;
    return at(this.room.x_min + (column + 0.5) * CELL_M, this.room.y_min + (row + 0.5) * CELL_M, 0);
  }

  /** Distance of a floor point from the nearest wall or thing; negative outside of the room. */
  clearance(x, y) {
    const { room } = this;
    let nearest = Math.min(x - room.x_min, room.x_max - x, y - room.y_min, room.y_max - y);
    for (const solid of this.solids) {
      if (nearest < 0) break;
      nearest = Math.min(nearest, distanceTo(solid, x, y));
    }
    return nearest;
  }

  canStand(point) {
    return this.clearance(point.x, point.y) >= this.radius - 1e-6;
  }

  lineIsFree(a, b) {
    const count = Math.max(2, Math.floor(Math.hypot(b.x - a.x, b.y - a.y) / (CELL_M / 2)) + 1);
    for (let i = 0; i < count; i++) {
      const part = i / (count - 1);
      if (!this.canStand(at(a.x + (b.x - a.x) * part, a.y + (b.y - a.y) * part, 0))) return false;
    }
    return true;
  }

  /** All shortest ways from a place. */
  waysFrom(start) {
    let [nearest, cell] = [Infinity, 0];
    for (let i = 0; i < this.free.length; i++) {
      const centre = this.centre(i);
      const far = Math.hypot(centre.x - start.x, centre.y - start.y);
      if (this.free[i] && far < nearest) [nearest, cell] = [far, i];
    }
    return new Ways(this, start, cell);
  }
}

class Ways {
  constructor(floor, start, cell) {
    this.floor = floor;
    this.start = start;
    this.cell = cell;
    this.lengths = new Float64Array(floor.free.length).fill(Infinity);
    this.before = new Int32Array(floor.free.length).fill(-1);
    this._spread();
  }

  // Dijkstra with a queue for each length in steps of half a cell: lengths differ by one cell or its diagonal.
  _spread() {
    const { floor, lengths, before } = this;
    const queues = [[this.cell]];
    lengths[this.cell] = 0;
    const width = CELL_M / 2;
    for (let at = 0; at < queues.length; at++) {
      for (const cell of queues[at] ?? []) {
        if (Math.floor(lengths[cell] / width) !== at) continue;
        for (const [next, step] of this._neighbours(cell)) {
          const length = lengths[cell] + step;
          if (!floor.free[next] || length >= lengths[next] - 1e-12) continue;
          lengths[next] = length;
          before[next] = cell;
          (queues[Math.floor(length / width)] ??= []).push(next);
        }
      }
    }
  }

  *_neighbours(cell) {
    const { rows, columns } = this.floor;
    const [column, row] = [Math.floor(cell / rows), cell % rows];
    for (let dx = -1; dx <= 1; dx++)
      for (let dy = -1; dy <= 1; dy++) {
        const [x, y] = [column + dx, row + dy];
        if ((dx || dy) && x >= 0 && y >= 0 && x < columns && y < rows)
          yield [x * rows + y, CELL_M * Math.hypot(dx, dy)];
      }
  }

  /** The way to the reachable place nearest to a target: the very point if one can stand there. */
  toNearest(target) {
    const { floor, lengths } = this;
    const far = Array.from(lengths, (length, cell) => {
      const centre = floor.centre(cell);
      return length < Infinity ? Math.hypot(centre.x - target.x, centre.y - target.y) : Infinity;
    });
    const nearest = far.reduce((a, b) => Math.min(a, b), Infinity);
    const stands = floor.canStand(target);
    let [best, cell] = [Infinity, this.cell];
    far.forEach((value, i) => {
      // Of places that are about as near the shortest way decides.
      const cost = stands ? value : value <= nearest + CELL_M ? lengths[i] + value : Infinity;
      if (cost < best) [best, cell] = [cost, i];
    });
    const exact = stands && far[cell] < CELL_M;
    return this._way(cell, exact ? at(target.x, target.y, 0) : floor.centre(cell));
  }

  /** The shortest way to a place from which a target can be handled; null if there is none. */
  toStandingPlace(target, reach, keepOff, accept) {
    const { floor, lengths } = this;
    const places = [];
    lengths.forEach((length, cell) => {
      if (length === Infinity) return;
      const centre = floor.centre(cell);
      const far = Math.hypot(centre.x - target.x, centre.y - target.y);
      if (far <= reach && far >= keepOff) places.push([length + 0.01 * far, cell, centre]);
    });
    places.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    const found = places.find(([, , centre]) => accept(centre));
    return found ? this._way(found[1], found[2]) : null;
  }

  _way(cell, end) {
    const cells = [cell];
    while (cells.at(-1) !== this.cell) cells.push(this.before[cells.at(-1)]);
    const middle = cells.reverse().slice(1, -1).map((c) => this.floor.centre(c));
    return this._pulled([at(this.start.x, this.start.y, 0), ...middle, end]);
  }

  /** String pulling: leave out every corner that can be cut. */
  _pulled(points) {
    const kept = [points[0]];
    for (let i = 0; i < points.length - 1; ) {
      let ahead = points.length - 1;
      while (ahead > i + 1 && !this.floor.lineIsFree(points[i], points[ahead]))
        ahead = Math.max(i + 1, ahead - Math.max(1, Math.floor((ahead - i) / 8)));
      const last = kept.at(-1);
      if (Math.hypot(points[ahead].x - last.x, points[ahead].y - last.y) > 1e-9) kept.push(points[ahead]);
      i = ahead;
    }
    return kept;
  }
}
