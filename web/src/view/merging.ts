// Joins what never moves into one mesh a material: far fewer draw calls.

import { BufferAttribute, BufferGeometry, type Material, Matrix3, Mesh, Object3D } from "three";
import { floats, placed, turned } from "./floats.ts";

/** A mesh's geometry in the world's frame, with exactly the attributes that are named. */
function standing(mesh: Mesh, names: readonly string[]): BufferGeometry {
  const geometry = new BufferGeometry();
  mesh.updateWorldMatrix(true, false);
  for (const name of names) {
    const own = mesh.geometry.getAttribute(name);
    // Packed numbers could not be turned and moved.
    const values = floats(own);
    if (name === "position") placed(values, mesh.matrixWorld, values);
    if (name === "normal") turned(values, new Matrix3().getNormalMatrix(mesh.matrixWorld), values);
    geometry.setAttribute(name, new BufferAttribute(values, own.itemSize));
  }
  geometry.setIndex(mesh.geometry.getIndex());
  return geometry;
}

/** Geometries with the same attributes as one. */
function joined(parts: readonly BufferGeometry[]): BufferGeometry {
  const out = new BufferGeometry();
  for (const [name, { itemSize }] of Object.entries(parts[0]?.attributes ?? {})) {
    const own = parts.map((part) => part.getAttribute(name).array);
    const values = new Float32Array(own.reduce((sum, { length }) => sum + length, 0));
    let at = 0;
    for (const array of own) {
      values.set(array, at);
      at += array.length;
    }
    out.setAttribute(name, new BufferAttribute(values, itemSize));
  }
  const counts = parts.map((part) => part.getIndex()?.count ?? part.getAttribute("position").count);
  const index = new Uint32Array(counts.reduce((sum, count) => sum + count, 0));
  let [at, from] = [0, 0];
  parts.forEach((part, n) => {
    const own = part.getIndex()?.array;
    const count = counts[n] as number;
    for (let i = 0; i < count; i++) index[at++] = from + (own ? (own[i] as number) : i);
    from += part.getAttribute("position").count;
  });
  out.setIndex(new BufferAttribute(from > 65_535 ? index : Uint16Array.from(index), 1));
  return out;
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
    const sizes = names.map((name) => mesh.geometry.getAttribute(name).itemSize);
    const key = `${material.uuid} ${names.join(" ")} ${sizes.join(" ")}`;
    const known = byLooks.get(key);
    if (known) known.meshes.push(mesh);
    else byLooks.set(key, { material, meshes: [mesh], names });
  }
  for (const { material, meshes: alike, names } of byLooks.values()) {
    group.add(new Mesh(joined(alike.map((mesh) => finer(mesh, standing(mesh, names)))), material));
  }
  return group;
}
