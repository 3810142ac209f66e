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
import { DAY, type Extent, GLOW, LAMP, type Sources, sidesOf, skyOf, sourcesOf } from "./brightness.ts";


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
function probe(sources: Sources): LightProbe {
  const light = new LightProbe();
  const out = light.sh.coefficients;
  for (const { way, light: rgb } of sidesOf(sources)) {
    out[0]?.addScaledVector(rgb, 0.282095 * 2);
    out[1]?.addScaledVector(rgb, 0.488603 * way.y);
    out[2]?.addScaledVector(rgb, 0.488603 * way.z);
    out[3]?.addScaledVector(rgb, 0.488603 * way.x);
  }
  return light;
}

/**
 * The lights of a room.
 * @param window Where the window is; null if there is none.
 * @param isMatt Nothing is reflected: what surfaces give back comes from here.
 */
export function lightRoom(scene: Extent, window: Vector3 | null, isMatt = false): Lights {
  const group = new Group();
  const sources = sourcesOf(scene, window);
  const lamp = new SpotLight(LAMP.colour, 1);
  lamp.position.copy(sources.lamp);
  lamp.target.position.copy(sources.middle);
  lamp.angle = LAMP.angle;
  lamp.penumbra = LAMP.penumbra;
  lamp.decay = 0;
  lamp.castShadow = true;
  lamp.shadow.mapSize.set(2048, 2048);
  lamp.shadow.camera.near = 0.25;
  lamp.shadow.camera.far = Math.hypot(scene.x_max - scene.x_min, scene.y_max - scene.y_min, scene.height_m);
  lamp.shadow.bias = -0.0006;
  lamp.shadow.normalBias = 0.02;
  lamp.shadow.radius = 5;
  lamp.shadow.autoUpdate = false;
  const day = new DirectionalLight(DAY.colour, 1);
  day.position.copy(sources.day);
  day.target.position.copy(sources.middle).setZ(0.9);
  const glow = new PointLight(GLOW.colour, 1, GLOW.reach, GLOW.decay);
  glow.position.copy(sources.glow);
  const sky = isMatt ? probe(sources) : null;
  group.add(lamp, lamp.target, day, day.target, glow);
  if (sky) group.add(sky);
  const dim = (share: number): void => {
    lamp.intensity = LAMP.strength * share;
    day.intensity = DAY.strength * share;
    glow.intensity = GLOW.strength * share;
    if (sky) sky.intensity = skyOf(share);
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
