// Ambient light is dimmer in corners, under tables and behind sofas. How dim is worked out once for a
// grid of points, from the cubes of the room, and every surface looks it up.

import { Data3DTexture, LinearFilter, type Material, RedFormat, Vector3 } from "three";
import { CELL_M, type Voxels } from "./voxels.ts";

const FAR_M = 0.9;
const STRENGTH = 0.85;

/** Evenly spread directions (a Fibonacci sphere). */
function directions(count: number): Vector3[] {
  const golden = Math.PI * (3 - Math.sqrt(5));
  return Array.from({ length: count }, (_, i) => {
    const z = 1 - (2 * (i + 0.5)) / count;
    const flat = Math.sqrt(1 - z * z);
    return new Vector3(Math.cos(golden * i) * flat, Math.sin(golden * i) * flat, z);
  });
}

const RAYS = directions(22);

function opennessAt(room: Voxels, x: number, y: number, z: number): number {
  const { min, max } = room.box;
  let open = 0;
  for (const ray of RAYS) {
    let seen = FAR_M;
    for (let s = CELL_M * 0.9; s < FAR_M; s += CELL_M * 0.9) {
      const [px, py, pz] = [x + ray.x * s, y + ray.y * s, z + ray.z * s];
      const outside = px < min.x || py < min.y || pz < min.z || px > max.x || py > max.y || pz > max.z;
      if (outside || room.isFilled(px, py, pz)) {
        seen = s;
        break;
      }
    }
    open += seen / FAR_M;
  }
  return open / RAYS.length;
}

/** How open the surroundings of each cell are, 0 to 255; a point in the middle of the room has 255. */
export function openness(room: Voxels): Data3DTexture {
  const { nx, ny, nz } = room;
  const data = new Uint8Array(nx * ny * nz);
  const { min } = room.box;
  for (let k = 0; k < nz; k++) {
    for (let j = 0; j < ny; j++) {
      for (let i = 0; i < nx; i++) {
        const open = opennessAt(room, min.x + (i + 0.5) * CELL_M, min.y + (j + 0.5) * CELL_M, min.z + (k + 0.5) * CELL_M);
        data[i + nx * (j + ny * k)] = Math.round(255 * open);
      }
    }
  }
  const texture = new Data3DTexture(data, nx, ny, nz);
  texture.format = RedFormat;
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  return texture;
}

export interface Ambience {
  uOpenness: { value: Data3DTexture };
  uRoomMin: { value: Vector3 };
  uRoomSize: { value: Vector3 };
}

export function ambienceOf(room: Voxels): Ambience {
  return {
    uOpenness: { value: openness(room) },
    uRoomMin: { value: room.box.min.clone() },
    uRoomSize: { value: room.box.getSize(new Vector3()) },
  };
}

const VERTEX = `#include <project_vertex>
vRoomPlace = (modelMatrix * vec4(transformed, 1.0)).xyz;`;

/** A plain surface has about half of its surroundings behind it: that much is no dimness. */
const FRAGMENT = `#include <aomap_fragment>
{
  vec3 outwards = inverseTransformDirection(normal, viewMatrix);
  vec3 place = (vRoomPlace + outwards * 0.11 - uRoomMin) / uRoomSize;
  float open = smoothstep(0.12, 0.74, texture(uOpenness, clamp(place, 0.0, 1.0)).r);
  float share = mix(1.0, 0.25 + 0.75 * open, ${STRENGTH.toFixed(2)});
  reflectedLight.indirectDiffuse *= share;
  reflectedLight.indirectSpecular *= share;
  reflectedLight.directDiffuse *= mix(1.0, share, 0.35);
}`;

/** Let a material look up how open its place is. */
export function dimBy(material: Material, ambience: Ambience): void {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, ambience);
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
