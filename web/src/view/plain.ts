// The plain look: light at the corners of triangles, one picture, and next to nothing to work out for each
// pixel. It is there at once everywhere, and it is what a processor draws that stands in for a graphics card.

import {
  BufferAttribute,
  type BufferGeometry,
  GLSL3,
  LinearMipmapNearestFilter,
  type Material,
  type Matrix4,
  type MeshStandardMaterial,
  NoColorSpace,
  RawShaderMaterial,
  type Texture,
  Vector3,
} from "three";
import type { BodyLight } from "./bodylight.ts";
import { type Brightness, skyOf } from "./brightness.ts";
import { coded, MOST } from "./coding.ts";
import { floats, placed, turned } from "./floats.ts";
import { WHITE } from "./surfaces.ts";

const VERTEX = `
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
in vec3 position;
in vec2 uv;
in vec4 light;
out vec2 vUv;
out mediump vec4 vLight;
void main() {
  vUv = uv;
  vLight = light * vec4(vec3(${MOST.toFixed(1)}), 1.0);
  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));
}`;

/** Squares and roots in place of sRGB, a little haze in place of reflections, and a curve close to the filmic one of the full look. */
const FRAGMENT = `
precision mediump float;
uniform sampler2D map;
in highp vec2 vUv;
in vec4 vLight;
layout(location = 0) out vec4 outColour;
void main() {
  vec4 seen = texture(map, vUv) * vLight;
  vec3 c = seen.rgb * seen.rgb;
  c = mix(vec3(dot(c, vec3(0.3, 0.6, 0.1)) + 0.012), c, 0.88);
  c = c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14);
  outColour = vec4(sqrt(c), seen.a);
}`;

interface Baked {
  light: BufferAttribute;
  /** What the lamps give each corner, and what its surroundings do, with its own colour. */
  direct: Float32Array;
  sky: Float32Array;
  shine: readonly number[];
}

export class Plain {
  /** Shares of lamps and surroundings that are left where the lights are dimmed. */
  private dims: readonly [lamps: number, sky: number] = [1, 1];
  private readonly baked = new Map<BufferGeometry, Baked>();
  private readonly maps = new Map<Texture, Texture>();
  private readonly made = new Map<Material, Material>();

  /** @param brightness Tells the light of a place; another one holds for what is lit from then on. */
  constructor(public brightness: Brightness) {}

  /** How a material of a file is drawn plainly. */
  look(own: Material): Material {
    const known = this.made.get(own);
    if (known) return known;
    const { map, name, transparent, depthWrite, side } = own as MeshStandardMaterial;
    const look = this.shown(this.raw(map ?? WHITE));
    Object.assign(look, { name, transparent, depthWrite, side });
    this.made.set(own, look);
    return look;
  }

  /** A picture that lets through what is behind it. */
  veil(map: Texture): Material {
    return Object.assign(this.shown(map), { transparent: true, depthWrite: false });
  }

  private shown(map: Texture): RawShaderMaterial {
    return new RawShaderMaterial({ glslVersion: GLSL3, uniforms: { map: { value: map } }, vertexShader: VERTEX, fragmentShader: FRAGMENT });
  }

  /** A picture as it is in its file: to turn sRGB into light for each pixel takes a processor long. */
  private raw(map: Texture): Texture {
    const known = this.maps.get(map);
    if (known) return known;
    const raw = map.clone();
    raw.colorSpace = NoColorSpace;
    raw.anisotropy = 1;
    if (raw.generateMipmaps) raw.minFilter = LinearMipmapNearestFilter;
    this.maps.set(map, raw);
    return raw;
  }

  /**
   * Work out the light at every corner of something.
   * @param at Where it is in the room.
   * @param isStill Whether it stays there; then it is also in the shadow of what stands still.
   */
  light(geometry: BufferGeometry, own: Material, at: Matrix4, isStill: boolean): void {
    const [places, normals] = [geometry.getAttribute("position"), geometry.getAttribute("normal")];
    const baked = this.baked.get(geometry) ?? this.begin(geometry, own);
    const from = placed(floats(places), at, new Float64Array(places.count * 3));
    const facing = turned(floats(normals), at, new Float64Array(normals.count * 3));
    this.fall(baked, from, facing, isStill);
    const tint = "color" in own ? (own as MeshStandardMaterial).color.toArray() : [1, 1, 1];
    const colours = geometry.hasAttribute("color") ? geometry.getAttribute("color") : null;
    paint(baked, tint, colours ? floats(colours) : null, colours?.itemSize ?? 0);
    this.shade(baked);
  }

  /** Let light fall on corners, whatever their colour. */
  private fall({ direct, sky }: Baked, places: Float64Array, ways: Float64Array, isStill: boolean): void {
    const { brightness } = this;
    const place = new Vector3();
    const outwards = new Vector3();
    const found = new Float32Array(6);
    for (let i = 0; i < places.length; i += 3) {
      place.set(places[i] as number, places[i + 1] as number, places[i + 2] as number);
      outwards.set(ways[i] as number, ways[i + 1] as number, ways[i + 2] as number);
      brightness.at(place, outwards, isStill, found);
      for (let k = 0; k < 3; k++) {
        direct[i + k] = found[k] as number;
        sky[i + k] = found[k + 3] as number;
      }
    }
  }

  /** Keep room for the light of something, which is dark until its light is worked out. */
  begin(geometry: BufferGeometry, own: Material): Baked {
    const { count } = geometry.getAttribute("position");
    const colours = geometry.hasAttribute("color") ? geometry.getAttribute("color") : null;
    const light = new BufferAttribute(new Uint8ClampedArray(count * 4), 4, true);
    for (let i = 0; i < count; i++) light.array[i * 4 + 3] = 255 * (colours?.getW(i) ?? 1);
    geometry.setAttribute("light", light);
    const shine = "emissive" in own ? (own as MeshStandardMaterial).emissive.toArray() : [0, 0, 0];
    const baked = { light, direct: new Float32Array(count * 3), sky: new Float32Array(count * 3), shine };
    this.baked.set(geometry, baked);
    return baked;
  }

  /** What shines by itself, about as bright as its picture. */
  shine(geometry: BufferGeometry): void {
    const { count } = geometry.getAttribute("position");
    geometry.setAttribute("light", new BufferAttribute(new Uint8ClampedArray(count * 4).fill(coded(1.2)), 4, true));
  }

  /** Keep no light for something that is gone. */
  forget(geometry: BufferGeometry): void {
    this.baked.delete(geometry);
  }

  /** The light on a body that stands somewhere. */
  around(x: number, y: number): BodyLight {
    return this.brightness.around(x, y, this.dims);
  }

  /** Change the brightness: 1 is a lit room, 0 a dark one. */
  dim(share: number): void {
    if (share === this.dims[0]) return;
    this.dims = [share, skyOf(share)];
    for (const baked of this.baked.values()) this.shade(baked);
  }

  private shade({ light, direct, sky, shine }: Baked): void {
    const lamps = this.dims[0];
    const surroundings = this.dims[1];
    const out = light.array;
    for (let i = 0; i < light.count; i++) {
      for (let k = 0; k < 3; k++) {
        const from = i * 3 + k;
        out[i * 4 + k] = coded((direct[from] as number) * lamps + (sky[from] as number) * surroundings + (shine[k] as number));
      }
    }
    light.needsUpdate = true;
  }

  /** Take from the graphics card what it is no longer asked for. */
  close(): void {
    for (const map of this.maps.values()) map.dispose();
    for (const material of this.made.values()) material.dispose();
  }
}

/** Give light that fell on corners the colour of the surface there. */
function paint({ direct, sky }: Baked, tint: readonly number[], colours: Float32Array | null, size: number): void {
  for (let i = 0; i < direct.length / 3; i++) {
    for (let k = 0; k < 3; k++) {
      const colour = (tint[k] as number) * (colours ? (colours[i * size + k] as number) : 1);
      direct[i * 3 + k] = (direct[i * 3 + k] as number) * colour;
      sky[i * 3 + k] = (sky[i * 3 + k] as number) * colour;
    }
  }
}
