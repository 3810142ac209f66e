// The meshes of a scene that is edited: furniture and objects from the catalog, areas, and where she starts.

import {
  BoxGeometry,
  BufferGeometry,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  EdgesGeometry,
  FrontSide,
  Group,
  Line,
  LineBasicMaterial,
  LineSegments,
  type Material,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  type Object3D,
  PlaneGeometry,
  SphereGeometry,
  Vector3,
} from "three";
import { loadGltf, meshesIn, nodesByName } from "../view/loading.ts";
import { merged } from "../view/merging.ts";
import { FINE_M, isFloor } from "../view/room.ts";
import { split } from "../view/splitting.ts";
import { mattLook } from "../view/surfaces.ts";
import { meshOfAsset } from "./remote.ts";
import type { FloorArea, SceneData, SceneLight, Three } from "./scene.ts";

const ACCENT = 0xf0976a;
const WAITING = new MeshLambertMaterial({ color: 0x9a8d80, transparent: true, opacity: 0.45 });
const AREA = new MeshBasicMaterial({ color: 0x3f86b8, transparent: true, opacity: 0.22, side: DoubleSide, depthWrite: false });
const HANDLE = new MeshBasicMaterial({ color: ACCENT });
const EDGE = new LineBasicMaterial({ color: 0x2f6f9f });
const BODY = new MeshLambertMaterial({ color: ACCENT, transparent: true, opacity: 0.75 });
const LAMP = new MeshBasicMaterial({ color: 0xffd36b });
const LAMP_LINE = new LineBasicMaterial({ color: 0xd99a1c });
const BEAM_M = 0.6;
const FLOOR_COLOUR = 0xb79a78;
/** What one looks in through. */
const UNSEEN = ["ceiling", "outside"];

/** Loads each asset once; until it is there, a box of its size stands for it. */
export class Assets {
  private readonly made = new Map<string, Object3D>();
  private readonly asked = new Set<string>();

  /**
   * @param arrived Called when an asset is there.
   * @param isPlain Whether it is to be drawn plainly: then it is lit elsewhere.
   */
  constructor(
    private readonly arrived: () => void,
    private readonly isPlain: boolean,
  ) {}

  has(name: string): boolean {
    return this.made.has(name);
  }

  /** A mesh of its own, with Z up and the asset's origin at zero. */
  copy(name: string, size: Three, isOnFloor: boolean): Object3D {
    const known = this.made.get(name);
    if (known) return known.clone();
    if (!this.asked.has(name)) void this.load(name);
    const box = new Mesh(new BoxGeometry(...size), WAITING);
    if (isOnFloor) box.position.z = size[2] / 2;
    return new Group().add(box);
  }

  private async load(name: string): Promise<void> {
    this.asked.add(name);
    try {
      const { scene } = await loadGltf(meshOfAsset(name));
      scene.rotation.x = Math.PI / 2; // glTF has Y up.
      for (const mesh of meshesIn(scene)) {
        if (!this.isPlain) mesh.material = mattLook(mesh.material as Material);
        mesh.castShadow = mesh.receiveShadow = true;
      }
      this.made.set(name, new Group().add(scene));
      this.arrived();
    } catch {
      // The box goes on standing for it.
    }
  }
}

/** The walls as one sees them from inside and from above; a bare floor where they cannot be had. */
export async function loadShell(url: string, room: SceneData["room"], isPlain: boolean): Promise<Object3D> {
  try {
    const nodes = nodesByName(await loadGltf(url));
    const shell = nodes.get("room");
    if (!shell) return bareFloor(room);
    shell.removeFromParent();
    if (isPlain) return plainShell(shell);
    for (const mesh of meshesIn(shell)) {
      const look = mattLook(mesh.material as Material).clone();
      look.side = FrontSide; // The near walls are looked through.
      mesh.material = look;
      mesh.visible = !UNSEEN.includes(look.name);
      mesh.receiveShadow = true;
    }
    return shell;
  } catch {
    return bareFloor(room);
  }
}

/** Cut finely enough for shades on the floor. */
function plainShell(shell: Object3D): Object3D {
  shell.updateMatrixWorld(true);
  const meshes = meshesIn(shell).filter((mesh) => !UNSEEN.includes((mesh.material as Material).name));
  for (const mesh of meshes) (mesh.material as Material).side = FrontSide;
  return merged(meshes, (mesh, geometry) => (isFloor(mesh) ? split(geometry, FINE_M) : geometry));
}

function bareFloor({ x_min, x_max, y_min, y_max }: SceneData["room"]): Object3D {
  const floor = new Mesh(new PlaneGeometry(x_max - x_min, y_max - y_min), new MeshLambertMaterial({ color: FLOOR_COLOUR }));
  floor.position.set((x_min + x_max) / 2, (y_min + y_max) / 2, 0);
  floor.receiveShadow = true;
  return floor;
}

/** An area on the floor; with handles at its corners while it is selected. */
export function areaMesh({ min, max }: FloorArea, isHeld: boolean): Object3D {
  const plane = new PlaneGeometry(Math.max(0.01, max[0] - min[0]), Math.max(0.01, max[1] - min[1]));
  const group = new Group().add(new Mesh(plane, AREA), new LineSegments(new EdgesGeometry(plane), EDGE));
  group.position.set((min[0] + max[0]) / 2, (min[1] + max[1]) / 2, 0.012);
  if (!isHeld) return group;
  for (const x of [-1, 1]) {
    for (const y of [-1, 1]) {
      const handle = new Mesh(new SphereGeometry(0.05, 12, 8), HANDLE);
      handle.position.set((x * (max[0] - min[0])) / 2, (y * (max[1] - min[1])) / 2, 0.02);
      group.add(handle);
    }
  }
  return group;
}

/** A lamp with a line to what it shines at; the brighter it is, the larger. */
export function lightMesh({ position, target, diffuse }: SceneLight): Object3D {
  const way = new Vector3(...target).sub(new Vector3(...position));
  const beam = new BufferGeometry().setFromPoints([new Vector3(), way.setLength(Math.min(way.length(), BEAM_M))]);
  return new Group().add(new Mesh(new SphereGeometry(0.06 + 0.06 * diffuse, 16, 12), LAMP), new Line(beam, LAMP_LINE));
}

/** A person in outline, looking along x. */
export function startMesh(): Object3D {
  const upright = (mesh: Mesh): Mesh => {
    mesh.rotation.x = Math.PI / 2;
    return mesh;
  };
  const body = upright(new Mesh(new CylinderGeometry(0.16, 0.22, 1.35, 20), BODY));
  body.position.z = 0.675;
  const head = upright(new Mesh(new CylinderGeometry(0.1, 0.1, 0.24, 20), BODY));
  head.position.z = 1.5;
  const nose = new Mesh(new ConeGeometry(0.1, 0.3, 16), BODY);
  nose.rotation.z = -Math.PI / 2;
  nose.position.set(0.34, 0, 0.1);
  return new Group().add(body, head, nose);
}
