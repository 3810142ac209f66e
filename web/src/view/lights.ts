// The light of the room: a lamp near the ceiling with soft shadows, the window, and what all surfaces give back.

import {
  BackSide,
  BoxGeometry,
  Color,
  DirectionalLight,
  Group,
  LightProbe,
  Mesh,
  MeshBasicMaterial,
  PMREMGenerator,
  PlaneGeometry,
  PointLight,
  Scene,
  SpotLight,
  type Texture,
  Vector3,
  type WebGLRenderer,
} from "three";
import type { SceneShape } from "../protocol.ts";

const WARM = 0xfff0dc;
const SKY = 0xf3f6ff;

const SKY_SHARE = 1.55;

/** How far a room reaches. */
type Extent = Pick<SceneShape, "x_min" | "x_max" | "y_min" | "y_max" | "height_m">;

export interface Lights {
  group: Group;
  /** Change the brightness: 1 is a lit room, 0 a dark one. */
  dim: (share: number) => void;
  shadowSize: (size: number) => void;
  /** Draw the shadows anew with the next picture. */
  refresh: () => void;
}

/** What surfaces reflect: a warm room with one bright side, made in code. */
export function surroundings(renderer: WebGLRenderer, window: Vector3): Texture {
  const scene = new Scene();
  const wall = new MeshBasicMaterial({ color: new Color(0.5, 0.46, 0.42), side: BackSide });
  scene.add(new Mesh(new BoxGeometry(10, 10, 5), wall));
  const panel = (color: Color, width: number, height: number, at: Vector3): void => {
    const mesh = new Mesh(new PlaneGeometry(width, height), new MeshBasicMaterial({ color }));
    mesh.position.copy(at);
    mesh.lookAt(0, 0, 0);
    scene.add(mesh);
  };
  panel(new Color(2.6, 2.45, 2.2), 6, 6, new Vector3(0, 0, 2.4));
  panel(new Color(5, 5.2, 5.6), 3, 2.4, window.clone().setZ(0).normalize().multiplyScalar(4.4).setZ(0.6));
  panel(new Color(0.42, 0.34, 0.27), 10, 10, new Vector3(0, 0, -2.4));
  const maker = new PMREMGenerator(renderer);
  const texture = maker.fromScene(scene, 0.06, 0.1, 20).texture;
  maker.dispose();
  return texture;
}

/** The same surroundings as a few numbers: no reflections, but cheap where a processor draws. */
function probe(window: Vector3): LightProbe {
  const light = new LightProbe();
  const out = light.sh.coefficients;
  const side = window.clone().setZ(0).normalize();
  const add = (way: Vector3, colour: Color, share: number): void => {
    const rgb = new Vector3(colour.r, colour.g, colour.b).multiplyScalar(share);
    out[0]?.addScaledVector(rgb, 0.282095 * 2);
    out[1]?.addScaledVector(rgb, 0.488603 * way.y);
    out[2]?.addScaledVector(rgb, 0.488603 * way.z);
    out[3]?.addScaledVector(rgb, 0.488603 * way.x);
  };
  add(new Vector3(0, 0, 1), new Color(1, 0.96, 0.9), 1.15);
  add(new Vector3(0, 0, -1), new Color(0.62, 0.5, 0.4), 0.5);
  add(side, new Color(0.95, 0.98, 1), 0.75);
  add(side.clone().negate(), new Color(0.8, 0.72, 0.62), 0.4);
  return light;
}

/** Whether a processor draws in place of a graphics card. */
export function isSoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  const about = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = gl && about ? String(gl.getParameter(about.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

/**
 * The lights of a room.
 * @param window Where the window is; null if there is none.
 * @param isPlain Leave out what costs much; the surroundings then come from here.
 */
export function lightRoom(scene: Extent, window: Vector3 | null, isPlain: boolean): Lights {
  const group = new Group();
  const middle = new Vector3((scene.x_min + scene.x_max) / 2, (scene.y_min + scene.y_max) / 2, 0);
  const [width, depth] = [scene.x_max - scene.x_min, scene.y_max - scene.y_min];
  const lamp = new SpotLight(WARM, 1);
  lamp.position.set(middle.x - width * 0.16, middle.y - depth * 0.1, scene.height_m - 0.08);
  lamp.target.position.set(middle.x, middle.y, 0);
  lamp.angle = 1.28;
  lamp.penumbra = 0.9;
  lamp.decay = 0;
  lamp.castShadow = true;
  lamp.shadow.mapSize.set(2048, 2048);
  lamp.shadow.camera.near = 0.25;
  lamp.shadow.camera.far = Math.hypot(width, depth, scene.height_m);
  lamp.shadow.bias = -0.0006;
  lamp.shadow.normalBias = 0.02;
  lamp.shadow.radius = 5;
  lamp.shadow.autoUpdate = false;
  const day = new DirectionalLight(SKY, 1);
  const from = window ?? new Vector3(scene.x_max, middle.y, scene.height_m * 0.6);
  day.position.copy(from).lerp(new Vector3(middle.x, middle.y, scene.height_m * 2), 0.25);
  day.target.position.set(middle.x, middle.y, 0.9);
  const glow = new PointLight(SKY, 1, 5, 1.2);
  glow.position.copy(from).lerp(new Vector3(middle.x, middle.y, 1.6), 0.14);
  const sky = isPlain ? probe(from.clone().sub(middle)) : null;
  group.add(lamp, lamp.target, day, day.target, glow);
  if (sky) group.add(sky);
  const dim = (share: number): void => {
    lamp.intensity = 1.75 * share;
    day.intensity = 0.55 * share;
    glow.intensity = 1.3 * share;
    if (sky) sky.intensity = SKY_SHARE * (0.25 + 0.75 * share);
  };
  dim(1);
  return {
    group,
    dim,
    shadowSize: (size) => {
      if (lamp.shadow.mapSize.x === size) return;
      lamp.shadow.mapSize.set(size, size);
      lamp.shadow.map?.dispose();
      lamp.shadow.map = null;
      lamp.shadow.needsUpdate = true;
    },
    refresh: () => {
      lamp.shadow.needsUpdate = true;
    },
  };
}
