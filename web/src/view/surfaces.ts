// How surfaces look: what a scene's file says of a material, put right for the light of the page.

import { DataTexture, LinearMipmapNearestFilter, type Material, MeshLambertMaterial, type MeshStandardMaterial } from "three";
import { type Ambience, dimBy } from "./ambience.ts";
import { isStandard } from "./loading.ts";

export const WHITE = new DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
WHITE.needsUpdate = true;
/** Lampshades, and what glows in them. */
export const SHADES: readonly string[] = ["shade", "glow"];
const ROUGHNESS: Record<string, number> = { parquet: 0.52, walls: 0.95, glass: 0.12, head: 0.62, hands: 0.62, eyes: 0.15, hair: 0.6 };
const ready = new WeakMap<Material, Material>();
const mattOf = new WeakMap<Material, Material>();

/** A material of a file, put right. */
export function surface(material: Material): Material {
  const known = ready.get(material);
  if (known) return known;
  const surface = isStandard(material) ? righted(material) : material;
  ready.set(material, surface);
  return surface;
}

function righted(material: MeshStandardMaterial): MeshStandardMaterial {
  const { name } = material;
  material.roughness = ROUGHNESS[name] ?? material.roughness;
  if (name === "parquet") material.color.setScalar(0.8);
  if (name === "glass") material.transparent = true;
  if (name === "glass") material.depthWrite = false;
  if (SHADES.includes(name)) {
    material.emissive.copy(material.color).multiplyScalar(0.55);
    material.map = WHITE; // One program less to compile.
  }
  return material;
}

/** With reflections and shadows; where its place is not open, it is dimmer. */
export function fullLook(material: Material, ambience: Ambience): Material {
  if (!isStandard(material)) {
    material.toneMapped = false;
    return material;
  }
  if (material.map) material.map.anisotropy = 4;
  dimBy(material, ambience);
  return material;
}

/** Without reflections, for the editor: a fraction of the work a pixel. */
export function mattLook(own: Material): Material {
  const material = surface(own);
  const known = mattOf.get(material);
  if (known || !isStandard(material)) return known ?? material;
  const { name, map, color, emissive, transparent, depthWrite, vertexColors, side } = material;
  if (map) map.minFilter = LinearMipmapNearestFilter;
  const look = new MeshLambertMaterial({ name, map, color, emissive, transparent, depthWrite, vertexColors, side });
  mattOf.set(material, look);
  return look;
}
