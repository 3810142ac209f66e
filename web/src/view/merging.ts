// Joins what never moves into one mesh a material: far fewer draw calls.

import { BufferAttribute, BufferGeometry, type InterleavedBufferAttribute, type Material, Mesh, Object3D } from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

type Attribute = BufferAttribute | InterleavedBufferAttribute;

/** Packed numbers as floats, so that they can be turned and moved. */
function asFloats(attribute: Attribute): BufferAttribute {
  const size = attribute.itemSize;
  const out = new Float32Array(attribute.count * size);
  for (let i = 0; i < attribute.count; i++) {
    for (let k = 0; k < size; k++) out[i * size + k] = attribute.getComponent(i, k);
  }
  return new BufferAttribute(out, size);
}

/** A mesh's geometry in the world's frame, with exactly the attributes that are named. */
function placed(mesh: Mesh, names: readonly string[]): BufferGeometry {
  const geometry = new BufferGeometry();
  for (const name of names) {
    const own = mesh.geometry.getAttribute(name);
    if (own) geometry.setAttribute(name, asFloats(own));
  }
  const index = mesh.geometry.getIndex();
  if (index) geometry.setIndex(Array.from(index.array));
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
