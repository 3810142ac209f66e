// Ambient light is dimmer in corners, under tables and behind sofas. How dim is worked out once for a
// grid of points, from the cubes of the room, and every surface looks it up.

import { Data3DTexture, LinearFilter, type Material, RedFormat, Vector3 } from "three";
import { CELL_M, type Voxels } from "./voxels.ts";

const FAR_M = 0.9;
/** A plain surface has about half of its surroundings behind it: that much is no dimness. */
const [DARK, BRIGHT] = [0.12, 0.74];
const STRENGTH = 0.85;
/** Share of the dimness that light from a lamp has as well. */
export const DIRECT_SHARE = 0.35;
const RAYS = 22;
const STEP_M = CELL_M * 0.9;
/** Cells that a ray is long at most. */
const MARGIN = Math.ceil(FAR_M / CELL_M);

/** Evenly spread directions (a Fibonacci sphere). */
function directions(count: number): Vector3[] {
  const golden = Math.PI * (3 - Math.sqrt(5));
  return Array.from({ length: count }, (_, i) => {
    const z = 1 - (2 * (i + 0.5)) / count;
    const flat = Math.sqrt(1 - z * z);
    return new Vector3(Math.cos(golden * i) * flat, Math.sin(golden * i) * flat, z);
  });
}

/** For each direction, how far apart the cells are that a ray passes, from the cell where it begins. */
function rays(nx: number, ny: number): Int32Array[] {
  return directions(RAYS).map((way) =>
    Int32Array.from({ length: Math.floor(FAR_M / STEP_M - 1e-9) }, (_, step) => {
      const s = (step + 1) * STEP_M / CELL_M;
      const [i, j, k] = [way.x, way.y, way.z].map((share) => Math.floor(0.5 + share * s)) as [number, number, number];
      return i + nx * (j + ny * k);
    }),
  );
}

/** What a material looks up to know how open its place is. */
interface Looked {
  uOpenness: { value: Data3DTexture };
  uRoomMin: { value: Vector3 };
  uRoomSize: { value: Vector3 };
}

/** How open the surroundings of each cell are; worked out when it is first asked for. */
export class Ambience {
  private readonly filled: Uint8Array;
  private readonly paths: Int32Array[];
  private readonly wide: number;
  private readonly deep: number;
  private readonly open: Uint8Array;
  private readonly known: Uint8Array;
  private looked: Looked | null = null;

  constructor(private readonly room: Voxels) {
    const { nx, ny, nz } = room;
    this.open = new Uint8Array(nx * ny * nz);
    this.known = new Uint8Array(nx * ny * nz);
    // With a margin that counts as filled no ray has to be asked whether it left the room.
    this.wide = nx + 2 * MARGIN;
    this.deep = ny + 2 * MARGIN;
    this.filled = new Uint8Array(this.wide * this.deep * (nz + 2 * MARGIN)).fill(1);
    for (let k = 0; k < nz; k++) {
      for (let j = 0; j < ny; j++) this.filled.set(room.filled.subarray(nx * (j + ny * k), nx * (j + 1 + ny * k)), this.within(0, j, k));
    }
    this.paths = rays(this.wide, this.deep);
  }

  private within(i: number, j: number, k: number): number {
    return i + MARGIN + this.wide * (j + MARGIN + this.deep * (k + MARGIN));
  }

  /** Of a cell, 0 to 255; a cell in the middle of the room has 255. */
  of(i: number, j: number, k: number): number {
    const { nx, ny } = this.room;
    const cell = i + nx * (j + ny * k);
    if (this.known[cell]) return this.open[cell] as number;
    const { filled, paths } = this;
    const here = this.within(i, j, k);
    let open = 0;
    for (const path of paths) {
      let step = 0;
      while (step < path.length && filled[here + (path[step] as number)] === 0) step++;
      open += step < path.length ? (step + 1) * STEP_M : FAR_M;
    }
    this.known[cell] = 1;
    return (this.open[cell] = Math.round((255 * open) / (paths.length * FAR_M)));
  }

  /** At a place, 0 to 1, between the cells around it. */
  at(x: number, y: number, z: number): number {
    const { nx, ny, nz, box } = this.room;
    const u = clamp((x - box.min.x) / CELL_M - 0.5, nx);
    const v = clamp((y - box.min.y) / CELL_M - 0.5, ny);
    const w = clamp((z - box.min.z) / CELL_M - 0.5, nz);
    const i = Math.floor(u);
    const j = Math.floor(v);
    const k = Math.floor(w);
    let sum = 0;
    for (let corner = 0; corner < 8; corner++) {
      const a = corner & 1;
      const b = (corner >> 1) & 1;
      const c = corner >> 2;
      const share = (a ? u - i : 1 - u + i) * (b ? v - j : 1 - v + j) * (c ? w - k : 1 - w + k);
      if (share > 0) sum += share * this.of(i + a, j + b, k + c);
    }
    return sum / 255;
  }

  /** All of it, for a shader. */
  get uniforms(): Looked {
    return (this.looked ??= this.look());
  }

  private look(): Looked {
    const { nx, ny, nz, box } = this.room;
    for (let k = 0; k < nz; k++) for (let j = 0; j < ny; j++) for (let i = 0; i < nx; i++) this.of(i, j, k);
    const texture = new Data3DTexture(this.open, nx, ny, nz);
    texture.format = RedFormat;
    texture.minFilter = texture.magFilter = LinearFilter;
    texture.unpackAlignment = 1;
    texture.needsUpdate = true;
    return { uOpenness: { value: texture }, uRoomMin: { value: box.min.clone() }, uRoomSize: { value: box.getSize(new Vector3()) } };
  }
}

const clamp = (value: number, count: number): number => Math.min(count - 1, Math.max(0, value));

const VERTEX = `#include <project_vertex>
vRoomPlace = (modelMatrix * vec4(transformed, 1.0)).xyz;`;

/** How bright the surroundings of a place are that is so open, 0 to 1. */
export function openShare(openness: number): number {
  const t = Math.min(1, Math.max(0, (openness - DARK) / (BRIGHT - DARK)));
  return 1 + (0.25 + 0.75 * t * t * (3 - 2 * t) - 1) * STRENGTH;
}

const FRAGMENT = `#include <aomap_fragment>
{
  vec3 outwards = inverseTransformDirection(normal, viewMatrix);
  vec3 place = (vRoomPlace + outwards * 0.11 - uRoomMin) / uRoomSize;
  float open = smoothstep(${DARK}, ${BRIGHT}, texture(uOpenness, clamp(place, 0.0, 1.0)).r);
  float share = mix(1.0, 0.25 + 0.75 * open, ${STRENGTH});
  reflectedLight.indirectDiffuse *= share;
  reflectedLight.indirectSpecular *= share;
  reflectedLight.directDiffuse *= mix(1.0, share, ${DIRECT_SHARE});
}`;

/** Let a material look up how open its place is. */
export function dimBy(material: Material, ambience: Ambience): void {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, ambience.uniforms);
    shader.vertexShader = `varying vec3 vRoomPlace;\n${shader.vertexShader.replace("#include <project_vertex>", VERTEX)}`;
    shader.fragmentShader = `varying vec3 vRoomPlace;
uniform mediump sampler3D uOpenness;
uniform vec3 uRoomMin;
uniform vec3 uRoomSize;
${shader.fragmentShader.replace("#include <aomap_fragment>", FRAGMENT)}`;
  };
  material.customProgramCacheKey = () => "dimmed";
  material.needsUpdate = true;
}
