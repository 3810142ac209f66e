// The scene as Babylon.js draws it: meshes, lights, the picture in colours, and the object at each pixel.

import { Engine } from "@babylonjs/core/Engines/engine.js";
import { Scene } from "@babylonjs/core/scene.js";
import { FreeCamera } from "@babylonjs/core/Cameras/freeCamera.js";
import { Color3, Color4 } from "@babylonjs/core/Maths/math.color.js";
import { Quaternion, Vector3 } from "@babylonjs/core/Maths/math.vector.js";
import { DirectionalLight } from "@babylonjs/core/Lights/directionalLight.js";
import { HemisphericLight } from "@babylonjs/core/Lights/hemisphericLight.js";
import { SpotLight } from "@babylonjs/core/Lights/spotLight.js";
import { ShadowGenerator } from "@babylonjs/core/Lights/Shadows/shadowGenerator.js";
import { LoadAssetContainerAsync } from "@babylonjs/core/Loading/sceneLoader.js";
import { RenderTargetTexture } from "@babylonjs/core/Materials/Textures/renderTargetTexture.js";
import { ShaderMaterial } from "@babylonjs/core/Materials/shaderMaterial.js";
import { StandardMaterial } from "@babylonjs/core/Materials/standardMaterial.js";
import { TransformNode } from "@babylonjs/core/Meshes/transformNode.js";
import "@babylonjs/loaders/glTF/2.0/glTFLoader.js";
import { direction } from "./geometry.js";
import { toPage, turnToPage } from "./frame.js";
import { idsOf } from "./ids.js";

const JPEG_QUALITY = 0.92;
const CLEAR_BELOW = 0.995;
/** Share of a lamp's half space that its shadows cover: 99 degrees. */
const SHADOWED = 0.55;
const FADE = 0.6;
const HEADLIGHT = 0.16;
/** Colours stay as they are painted: the light is added up without turning them linear. */
const READ = { pluginOptions: { gltf: { useSRGBBuffers: false } } };
const vector = (point) => new Vector3(...toPage(point));

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.engine = new Engine(canvas, true, { preserveDrawingBuffer: true, stencil: false });
    this.renderer = this.engine.getGlInfo().renderer;
  }

  /** Load an exported scene. @param base Address of its folder. */
  async load(told, base) {
    this.scene?.dispose();
    const scene = (this.scene = new Scene(this.engine));
    scene.useRightHandedSystem = true;
    scene.clearColor = new Color4(0.75, 0.82, 0.9, 1);
    this.camera = new FreeCamera("eyes", Vector3.Zero(), scene);
    this.camera.minZ = 0.03;
    this.camera.maxZ = 60;
    this.camera.rotationQuaternion = new Quaternion();
    const names = new Set([told.mesh, ...told.furniture.map((p) => p.mesh), ...told.objects.map((o) => o.mesh)]);
    const loaded = [...names].map(async (name) => [name, await LoadAssetContainerAsync(`${base}/${name}`, scene, READ)]);
    this.paints = new Map();
    this.assets = new Map(await Promise.all(loaded));
    this.room = this._placed(told.mesh, null);
    this.furniture = new Map(told.furniture.map((piece) => {
      const [x, y, z] = piece.position;
      const half = piece.yaw_rad / 2;
      const box = { center: { x, y, z }, orientation: { w: Math.cos(half), x: 0, y: 0, z: Math.sin(half) } };
      return [piece.name, this._placed(piece.mesh, box)];
    }));
    this.objects = new Map(told.objects.map((item) => [item.id, this._placed(item.mesh, item.box)]));
    this._light(told);
    this._markIds();
    await scene.whenReadyAsync();
  }

  _placed(mesh, box) {
    const root = new TransformNode(mesh, this.scene);
    root.rotationQuaternion = Quaternion.Identity();
    const made = this.assets.get(mesh).instantiateModelsToScene((name) => name, false, { doNotInstantiate: true });
    for (const node of made.rootNodes) node.parent = root;
    const thing = { root, meshes: root.getChildMeshes().filter((m) => m.getTotalVertices() > 0) };
    for (const mesh of thing.meshes) mesh.material = this._painted(mesh.material);
    if (box) this._move(thing, box);
    return thing;
  }

  /** A material as ADAMO's own rooms have them: light is added up as the numbers of its scenes mean it. */
  _painted(read) {
    if (!this.paints.has(read)) {
      const paint = new StandardMaterial(read.name, this.scene);
      paint.diffuseColor = read.albedoColor.toGammaSpace();
      paint.diffuseTexture = read.albedoTexture;
      paint.alpha = read.alpha;
      paint.specularColor = new Color3(0.5, 0.5, 0.5).scale(1 - read.roughness);
      paint.specularPower = 32;
      paint.backFaceCulling = false;
      paint.twoSidedLighting = true;
      paint.maxSimultaneousLights = 8;
      this.paints.set(read, paint);
    }
    return this.paints.get(read);
  }

  _move({ root }, box) {
    root.position.set(...toPage(box.center));
    root.rotationQuaternion.set(...turnToPage(box.orientation));
    root.computeWorldMatrix(true);
  }

  _light(told) {
    const ambient = new HemisphericLight("ambient", Vector3.Up(), this.scene);
    ambient.intensity = told.ambient;
    ambient.groundColor = Color3.White();
    ambient.specular = Color3.Black();
    this.headlight = new DirectionalLight("headlight", Vector3.Down(), this.scene);
    this.headlight.intensity = HEADLIGHT;
    this.headlight.specular = Color3.Black();
    this.shadows = [];
    told.lights.forEach((light, i) => {
      const [from, to] = [light.position, light.target].map(([x, y, z]) => new Vector3(...toPage({ x, y, z })));
      const lamp = new SpotLight(`lamp${i}`, from, to.subtract(from).normalize(), Math.PI, FADE, this.scene);
      lamp.diffuse = new Color3(...light.colour);
      lamp.specular = new Color3(0.15, 0.15, 0.15);
      if (light.shadow) this._shadow(lamp);
    });
  }

  _shadow(lamp) {
    lamp.shadowAngleScale = SHADOWED;
    lamp.shadowMinZ = 0.1;
    lamp.shadowMaxZ = 12;
    const shadows = new ShadowGenerator(2048, lamp);
    shadows.usePercentageCloserFiltering = true;
    shadows.bias = 0.0005;
    shadows.normalBias = 0.01;
    shadows.getShadowMap().refreshRate = RenderTargetTexture.REFRESHRATE_RENDER_ONCE;
    for (const thing of [...this.furniture.values(), ...this.objects.values()])
      for (const mesh of thing.meshes) shadows.addShadowCaster(mesh, false);
    for (const mesh of this.scene.meshes) mesh.receiveShadows = true;
    this.shadows.push(shadows);
  }

  /** A flat material for each mesh, whose colour is the number of its object. */
  _markIds() {
    const shader = {
      vertexSource: "precision highp float; attribute vec3 position; uniform mat4 worldViewProjection;" +
        "void main() { gl_Position = worldViewProjection * vec4(position, 1.0); }",
      fragmentSource: "precision highp float; uniform vec3 number; void main() { gl_FragColor = vec4(number, 1.0); }",
    };
    const flat = (red, green, blue) => {
      const options = { attributes: ["position"], uniforms: ["worldViewProjection", "number"] };
      const material = new ShaderMaterial("id", this.scene, shader, options);
      material.setVector3("number", new Vector3(red, green, blue));
      material.backFaceCulling = false;
      return material;
    };
    const nothing = flat(1, 1, 1);
    this.flat = new Map(this.scene.meshes.map((mesh) => [mesh, nothing]));
    this.clear = [];
    for (const thing of this.furniture.values())
      this.clear.push(...thing.meshes.filter((mesh) => mesh.material.alpha < CLEAR_BELOW));
    for (const [id, thing] of this.objects) {
      const material = flat(0, Math.floor(id / 256) / 255, (id % 256) / 255);
      for (const mesh of thing.meshes) this.flat.set(mesh, material);
      if (thing.meshes.some((mesh) => mesh.material.alpha < CLEAR_BELOW)) this.clear.push(...thing.meshes);
    }
  }

  /** Put everything where the world has it. */
  show(objects) {
    for (const item of objects) this._move(this.objects.get(item.id), item.box);
    for (const shadows of this.shadows)
      shadows.getShadowMap().refreshRate = RenderTargetTexture.REFRESHRATE_RENDER_ONCE;
  }

  aim({ position, yaw_rad, pitch_rad, fov_y_rad }) {
    const target = vector(direction(yaw_rad, pitch_rad));
    const up = vector(direction(yaw_rad, pitch_rad + Math.PI / 2));
    this.camera.position = vector(position);
    this.camera.fov = fov_y_rad;
    this.headlight.direction = target;
    // The camera of a right-handed scene looks along its own -Z.
    Quaternion.RotationQuaternionFromAxisToRef(Vector3.Cross(target, up), up, target.scale(-1), this.camera.rotationQuaternion);
  }

  /** The picture in colours, as JPEG. */
  async colours(width, height) {
    this._size(width, height);
    this.scene.render();
    const blob = await new Promise((done) => this.canvas.toBlob(done, "image/jpeg", JPEG_QUALITY));
    return new Uint8Array(await blob.arrayBuffer());
  }

  _size(width, height) {
    if (this.canvas.width !== width || this.canvas.height !== height) this.engine.setSize(width, height);
  }

  /** The object at each pixel, as layers of 16-bit numbers; a second one without what is see-through. */
  async ids(width, height) {
    const layers = [await this._layer(width, height, new Set())];
    if (this.clear.length) layers.push(await this._layer(width, height, new Set(this.clear)));
    return layers;
  }

  async _layer(width, height, without) {
    const target = new RenderTargetTexture("ids", { width, height }, this.scene, {
      generateMipMaps: false, samplingMode: RenderTargetTexture.NEAREST_SAMPLINGMODE, samples: 1,
    });
    target.activeCamera = this.camera;
    target.clearColor = new Color4(1, 1, 1, 1);
    target.renderList = this.scene.meshes.filter((mesh) => mesh.getTotalVertices() > 0 && !without.has(mesh));
    for (const mesh of target.renderList) target.setMaterialForRendering(mesh, this.flat.get(mesh));
    this.scene.updateTransformMatrix(true);
    target.render();
    const pixels = await target.readPixels();
    for (const mesh of target.renderList) target.setMaterialForRendering(mesh, undefined);
    target.dispose();
    return idsOf(new Uint8Array(pixels.buffer), width, height);
  }
}
