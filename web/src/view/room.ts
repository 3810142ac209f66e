// The room: walls, furniture and things, from one GLB. Frame: z up, metres, as the server has it.

import {
  Box3,
  DataTexture,
  Group,
  LinearMipmapNearestFilter,
  type Material,
  type Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  type MeshStandardMaterial,
  type Object3D,
  Vector3,
} from "three";
import type { Placed, SceneShape } from "../protocol.ts";
import { type Ambience, ambienceOf, dimBy } from "./ambience.ts";
import { isStandard, loadGltf, meshesIn, nodesByName, type Progress } from "./loading.ts";
import { merged } from "./merging.ts";
import { Voxels } from "./voxels.ts";

const WHITE = new DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
WHITE.needsUpdate = true;
const SHADES = ["shade", "glow"];

export class Room {
  readonly group = new Group();
  readonly things = new Map<number, Object3D>();
  readonly voxels: Voxels;
  readonly ambience: Ambience;
  readonly window: Vector3 | null;
  /** What the pointer can meet that does not move. */
  readonly fixed: Mesh[];

  private constructor(
    readonly scene: SceneShape,
    nodes: Map<string, Object3D>,
    isPlain: boolean,
  ) {
    const shell = nodes.get("room");
    const pieces = scene.furniture.map((piece) => nodes.get(piece.node)).filter((node) => node !== undefined);
    const still = [...(shell ? meshesIn(shell) : []), ...pieces.flatMap(meshesIn)];
    this.window = windowOf(still);
    this.voxels = new Voxels(
      new Box3(new Vector3(scene.x_min, scene.y_min, 0), new Vector3(scene.x_max, scene.y_max, scene.height_m)),
    );
    for (const mesh of pieces.flatMap(meshesIn)) if (!isFlat(mesh)) this.voxels.add(mesh);
    this.ambience = ambienceOf(this.voxels);
    const joined = merged(still);
    this.fixed = meshesIn(joined);
    for (const mesh of this.fixed) {
      mesh.receiveShadow = true;
      const { name } = mesh.material as Material;
      mesh.castShadow = !["walls", "ceiling", "parquet", "outside", ...SHADES].includes(name);
      mesh.matrixAutoUpdate = false;
    }
    this.group.add(joined);
    for (const object of scene.objects) {
      const node = nodes.get(object.node);
      if (!node) continue;
      node.userData.objectId = object.id;
      for (const mesh of meshesIn(node)) {
        mesh.receiveShadow = true;
        // Small things have their contact shadow; a processor has no time for a second one.
        mesh.castShadow = !isPlain && (mesh.material as Material).name !== "glass";
        mesh.userData.objectId = object.id;
      }
      this.things.set(object.id, node);
      this.group.add(node);
    }
    for (const mesh of meshesIn(this.group)) mesh.material = looks(mesh.material as Material, this.ambience, isPlain);
  }

  static async load(url: string, scene: SceneShape, isPlain: boolean, progress?: Progress): Promise<Room> {
    const gltf = await loadGltf(url, progress);
    const nodes = nodesByName(gltf);
    nodes.get("world")?.quaternion.identity();
    gltf.scene.updateMatrixWorld(true);
    return new Room(scene, nodes, isPlain);
  }

  place(id: number, at: Placed): void {
    const thing = this.things.get(id);
    if (!thing) return;
    thing.position.set(at[0], at[1], at[2]);
    thing.quaternion.set(at[3], at[4], at[5], at[6]);
  }
}

/** Whether it lies on the floor or hangs on a wall so flat that nothing can be behind it. */
function isFlat(mesh: Mesh): boolean {
  mesh.geometry.computeBoundingBox();
  const size = mesh.geometry.boundingBox?.clone().applyMatrix4(mesh.matrixWorld).getSize(new Vector3());
  return size !== undefined && size.z < 0.03;
}

function windowOf(meshes: readonly Mesh[]): Vector3 | null {
  const pane = meshes.find((mesh) => (mesh.material as Material).name === "outside");
  return pane ? new Box3().setFromObject(pane).getCenter(new Vector3()) : null;
}

const made = new WeakMap<Material, Material>();

/** The look of a material of the file under this light; plain where a processor draws. */
export function looks(material: Material, ambience: Ambience | null, isPlain: boolean): Material {
  const known = made.get(material);
  if (known) return known;
  const look = material.name === "outside" ? outside(material) : surface(material, ambience, isPlain);
  look.name = material.name;
  made.set(material, look);
  return look;
}

function outside(material: Material): Material {
  const map = "map" in material ? (material as MeshStandardMaterial).map : null;
  return new MeshBasicMaterial({ map, toneMapped: false });
}

const ROUGHNESS: Record<string, number> = { parquet: 0.52, walls: 0.95, glass: 0.12, head: 0.62, hands: 0.62, eyes: 0.15, hair: 0.6 };

function surface(material: Material, ambience: Ambience | null, isPlain: boolean): Material {
  if (!isStandard(material)) return material;
  const { name } = material;
  material.roughness = ROUGHNESS[name] ?? material.roughness;
  if (name === "parquet") material.color.setScalar(0.8);
  if (name === "glass") material.transparent = true;
  if (SHADES.includes(name)) {
    material.emissive.copy(material.color).multiplyScalar(0.55);
    material.map = WHITE; // One program less to compile.
  }
  if (material.map) {
    material.map.anisotropy = isPlain ? 1 : 4;
    if (isPlain) material.map.minFilter = LinearMipmapNearestFilter;
  }
  if (name === "glass") material.depthWrite = false;
  const look = isPlain ? plain(material) : material;
  if (ambience) dimBy(look, ambience);
  return look;
}

/** Without reflections: a fraction of the work a pixel. */
function plain(material: MeshStandardMaterial): MeshLambertMaterial {
  const { map, color, emissive, transparent, depthWrite, vertexColors, side } = material;
  return new MeshLambertMaterial({ map, color, emissive, transparent, depthWrite, vertexColors, side });
}
