// Loads a scene and a figure, and finds their parts by the names that they have in the file.

import { Bone, type Material, Mesh, MeshStandardMaterial, type Object3D, SkinnedMesh } from "three";
import { type GLTF, GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { Pictures } from "./pictures.ts";

export type Progress = (share: number) => void;

/** A file as soon as its shapes are there, and when its pictures are. */
export async function loadShapes(url: string, progress?: Progress): Promise<{ gltf: GLTF; pictures: Promise<unknown> }> {
  let pictures: Pictures | null = null;
  const loader = new GLTFLoader().register((parser) => (pictures = new Pictures(parser)));
  const gltf = await loader.loadAsync(url, (event) => {
    if (event.total > 0) progress?.(Math.min(1, event.loaded / event.total));
  });
  return { gltf, pictures: (pictures as Pictures | null)?.ready ?? Promise.resolve() };
}

export async function loadGltf(url: string): Promise<GLTF> {
  const { gltf, pictures } = await loadShapes(url);
  await pictures;
  return gltf;
}

/** The name of a node in the file; three changes it where it holds a slash or comes twice. */
export function nodeName(gltf: GLTF, object: Object3D): string {
  const index = gltf.parser.associations.get(object)?.nodes;
  const nodes = gltf.parser.json.nodes as { name?: string }[];
  return index === undefined ? "" : (nodes[index]?.name ?? "");
}

export function nodesByName(gltf: GLTF): Map<string, Object3D> {
  const found = new Map<string, Object3D>();
  gltf.scene.traverse((object) => {
    const name = nodeName(gltf, object);
    if (name && !found.has(name)) found.set(name, object);
  });
  return found;
}

export function bonesByName(gltf: GLTF): Map<string, Bone> {
  const found = new Map<string, Bone>();
  gltf.scene.traverse((object) => {
    if (object instanceof Bone) found.set(nodeName(gltf, object), object);
  });
  return found;
}

export function meshesIn(object: Object3D): Mesh[] {
  const found: Mesh[] = [];
  object.traverse((item) => {
    if (item instanceof Mesh) found.push(item);
  });
  return found;
}

export const skinnedIn = (object: Object3D): SkinnedMesh[] =>
  meshesIn(object).filter((mesh): mesh is SkinnedMesh => mesh instanceof SkinnedMesh);

export const isStandard = (material: Material): material is MeshStandardMaterial =>
  material instanceof MeshStandardMaterial;
