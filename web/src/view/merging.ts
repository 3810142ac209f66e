// Joins what never moves into one mesh a material: far fewer draw calls.

import { BufferAttribute, BufferGeometry, type Material, Mesh, Object3D } from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import { floats } from "./floats.ts";

/** A mesh's geometry in the world's frame, with exactly the attributes that are named. */
function placed(mesh: Mesh, names: readonly string[]): BufferGeometry {
  const geometry = new BufferGeometry();
  for (const name of names) {
    const own = mesh.geometry.getAttribute(name);
    // Packed numbers could not be turned and moved.
    if (own) geometry.setAttribute(name, new BufferAttribute(floats(own), own.itemSize));
  }
  const index = mesh.geometry.getIndex();
  if (index) geometry.setIndex(index.clone());
  mesh.updateWorldMatrix(true, false);
  return geometry.applyMatrix4(mesh.matrixWorld);
}

/**
 * One mesh for each material of some meshes.
 * @param finer What to do to the geometry of each before.
 */
export function merged(meshes: readonly Mesh[], finer: (mesh: Mesh, geometry: BufferGeometry) => BufferGeometry): Object3D {
  const group = new Object3D();
  const byLooks = new Map<string, { material: Material; meshes: Mesh[]; names: string[] }>();
  for (const mesh of meshes) {
    const material = mesh.material as Material;
    const names = Object.keys(mesh.geometry.attributes).sort();
    const key = `${material.uuid} ${names.join(" ")}`;
    const known = byLooks.get(key);
    if (known) known.meshes.push(mesh);
    else byLooks.set(key, { material, meshes: [mesh], names });
  }
  for (const { material, meshes: alike, names } of byLooks.values()) {
    const parts = alike.map((mesh) => finer(mesh, placed(mesh, names)));
    const geometry = mergeGeometries(parts, false);
    if (geometry) group.add(new Mesh(geometry, material));
  }
  return group;
}
