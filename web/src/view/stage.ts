// Draws the room: one renderer, one loop, a picture only when something changed.

import { ACESFilmicToneMapping, Color, PCFShadowMap, Scene, SRGBColorSpace, Vector3, WebGLRenderer } from "three";
import type { Hello } from "../protocol.ts";
import type { Moment } from "../track/track.ts";
import { Cameras } from "./cameras.ts";
import { ContactShadows } from "./contact.ts";
import { Figure } from "./figure.ts";
import type { Bearing } from "./life.ts";
import { type Lights, lightRoom, surroundings } from "./lights.ts";
import { loadShapes, meshesIn, type Progress } from "./loading.ts";
import { EXPOSURE } from "./coding.ts";
import { drawsPlainly } from "./machine.ts";
import { Quality } from "./quality.ts";
import { Room } from "./room.ts";

export interface Stats {
  frames: number;
  /** From the opening of the page to the first picture; 0 before. */
  firstMs: number;
  frameMs: number;
  scriptMs: number;
  calls: number;
  triangles: number;
  pixels: string;
}

/** So long it takes at least until pictures are being unpacked. */
const READ_MS = 8;
const WARM_FRAMES = 4;
const REFLECTED = 0.8;
/** After so long without a change the picture is drawn sharp. */
const STILL_MS = 350;

const ratio = (): number => Math.min(devicePixelRatio, 2);

/** Is called before each picture; returns whether something changed that the picture shows. */
export type Tick = (seconds: number) => boolean;

export class Stage {
  readonly scene = new Scene();
  readonly quality: Quality;
  readonly stats: Stats = { frames: 0, firstMs: 0, frameMs: 0, scriptMs: 0, calls: 0, triangles: 0, pixels: "" };
  private readonly lights: Lights;
  private readonly contact: ContactShadows;
  private readonly afterwards: (() => void)[] = [];
  private brightness = 1;
  private isSharp = true;
  private drawnAt = 0;
  private shadowsLate = true;
  /** Whether the full look is there. */
  private isFull = false;
  private dirty = true;
  private last = 0;
  private drewLast = false;
  private running = 0;
  /** Of the canvas on the page. To ask it for its size may lay the page out anew: it is asked when it changes. */
  private size = { width: 0, height: 0 };
  moment: Moment | null = null;

  private constructor(
    readonly renderer: WebGLRenderer,
    readonly hello: Hello,
    readonly room: Room,
    readonly figure: Figure,
    readonly cameras: Cameras,
    private readonly tick: Tick,
    private readonly isPlain: boolean,
  ) {
    this.quality = new Quality(isPlain);
    this.lights = lightRoom(hello.scene, room.window);
    this.contact = new ContactShadows(hello.scene.objects, room.plain);
    this.scene.background = new Color(0x1a1714);
    this.scene.environmentIntensity = REFLECTED;
    this.dress(false);
    this.scene.add(room.group, figure.group, this.contact.mesh);
    this.scene.matrixWorldAutoUpdate = false;
  }

  /** Get ready to draw: plainly at once, and fully as soon as that is prepared, unless a processor draws. */
  static async open(
    canvas: HTMLCanvasElement,
    hello: Hello,
    urls: { scene: string; figure: string },
    tick: Tick,
    progress?: Progress,
  ): Promise<Stage> {
    const loading = Promise.all([loadShapes(urls.scene, progress), loadShapes(urls.figure)]);
    const isPlain = drawsPlainly();
    const renderer = new WebGLRenderer({ canvas, antialias: !isPlain, powerPreference: "high-performance" });
    renderer.outputColorSpace = SRGBColorSpace;
    renderer.toneMapping = ACESFilmicToneMapping;
    renderer.toneMappingExposure = EXPOSURE;
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = PCFShadowMap;
    renderer.info.autoReset = false;
    const [scene, person] = await loading;
    // Meanwhile pictures are read, so that they are unpacked beside what follows.
    await new Promise((done) => setTimeout(done, READ_MS));
    const room = Room.of(scene.gltf, hello.scene);
    const figure = Figure.of(person.gltf, hello.joints, room);
    const cameras = new Cameras(hello.scene, hello.body, room.voxels);
    const stage = new Stage(renderer, hello, room, figure, cameras, tick, isPlain);
    await Promise.all([scene.pictures, person.pictures]);
    stage.prime();
    room.light();
    return stage;
  }

  /** Let shapes, pictures and programs be made ready to draw with, which goes on while light is worked out. */
  private prime(): void {
    const { renderer, scene, cameras } = this;
    const meshes = meshesIn(scene);
    const culled = meshes.filter((mesh) => mesh.frustumCulled);
    // A triangle of each is enough, wherever it is.
    for (const mesh of culled) mesh.frustumCulled = false;
    for (const { geometry } of meshes) geometry.setDrawRange(0, 3);
    renderer.render(scene, cameras.camera);
    renderer.getContext().flush();
    for (const { geometry } of meshes) geometry.setDrawRange(0, Infinity);
    for (const mesh of culled) mesh.frustumCulled = true;
  }

  private dress(isFull: boolean): void {
    this.isFull = isFull;
    this.room.dress(isFull);
    this.figure.dress(isFull);
    this.contact.isHers = !isFull;
  }

  /** Prepare reflections and shadows while the plain picture is shown, then draw with them. */
  private async enrich(): Promise<void> {
    const { renderer, scene, cameras, room, figure } = this;
    scene.environment = surroundings(renderer, room.window ?? new Vector3(1, 0, 0));
    scene.add(this.lights.group);
    for (const part of [room, figure]) part.dress(true);
    const ready = renderer.compileAsync(scene, cameras.camera);
    for (const part of [room, figure]) part.dress(false);
    await ready;
    this.dress(true);
    if (this.moment) this.show(this.moment);
    room.plain.close();
  }

  /** What she is at; until somebody tells, she leaves her bearing to the motion. */
  attends: () => Bearing = () => "busy";

  /** Called after each picture: for what lies over it, e.g. labels. */
  onDrawn(listener: () => void): void {
    this.afterwards.push(listener);
  }

  /** Draw again soon. */
  touch(): void {
    this.dirty = true;
  }

  show(moment: Moment): void {
    const first = this.moment === null;
    this.moment = moment;
    for (const [id, placed] of moment.things) this.room.place(id, placed);
    for (const [id, thing] of this.room.things) thing.visible = !moment.gone.has(id);
    if (moment.lights !== this.brightness) {
      this.brightness = moment.lights;
      this.lights.dim(moment.lights);
      this.room.plain.dim(moment.lights);
      this.scene.environmentIntensity = REFLECTED * (0.2 + 0.8 * moment.lights);
    }
    this.figure.pose(moment);
    this.contact.update(moment, this.figure);
    if (first) this.cameras.begin(moment);
    this.shadowsLate = true;
    this.dirty = true;
  }

  resize(): void {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    if (!width || !height) return;
    this.size = { width, height };
    this.setPixels(this.movingShare);
    this.cameras.resize(width, height);
    this.lights.shadowSize(this.quality.current.shadow);
    this.dirty = true;
  }

  private get movingShare(): number {
    const { width, height } = this.size;
    return this.quality.share(width * height * ratio() ** 2);
  }

  /** Draw with a share of the screen's own pixels. */
  private setPixels(share: number): void {
    const canvas = this.renderer.domElement;
    // Once for all: a processor that draws takes its time for each new size.
    this.renderer.setDrawingBufferSize(this.size.width, this.size.height, ratio() * share);
    this.stats.pixels = `${canvas.width}x${canvas.height}`;
    this.isSharp = share >= 1;
  }

  /** Where pictures of a movement are coarse, what stands still is drawn once more with all pixels. */
  private sharpen(now: number): void {
    if (this.isSharp || !this.moment || now - this.drawnAt < STILL_MS) return;
    this.setPixels(1);
    this.draw();
  }

  start(): void {
    const loop = (now: number): void => {
      this.running = requestAnimationFrame(loop);
      this.frame(now);
    };
    this.running = requestAnimationFrame(loop);
  }

  private frame(now: number): void {
    const since = this.last ? now - this.last : 16;
    this.last = now;
    const begin = performance.now();
    const seconds = Math.min(since / 1000, 0.25);
    if (this.tick(seconds)) this.dirty = true;
    if (this.figure.face.update(seconds)) this.dirty = true;
    if (this.moment && this.figure.live(seconds, this.bearing(), this.cameras.camera.position)) {
      this.shadowsLate = this.dirty = true;
    }
    if (this.moment && this.cameras.update(this.moment, this.figure, seconds)) this.dirty = true;
    if (!this.dirty || !this.moment) {
      this.drewLast = false;
      this.sharpen(now);
      return;
    }
    this.dirty = false;
    if (this.isSharp && this.movingShare < 1) this.setPixels(this.movingShare);
    this.draw();
    this.drawnAt = now;
    const spent = performance.now() - begin;
    const { stats } = this;
    // The first pictures wait for programs to be compiled: they say nothing about the others.
    if (++stats.frames === 1) this.afterFirst();
    if (stats.frames <= WARM_FRAMES) return;
    stats.scriptMs = stats.scriptMs ? stats.scriptMs * 0.9 + spent * 0.1 : spent;
    if (this.drewLast) {
      stats.frameMs = stats.frameMs ? stats.frameMs * 0.85 + since * 0.15 : since;
      if (this.quality.note(since)) this.resize();
    }
    this.drewLast = true;
  }

  /** How she bears herself: what looks out of her eyes goes with the motion alone. */
  private bearing(): Bearing {
    if (this.cameras.kind === "eyes") return "busy";
    return this.figure.face.heeds ?? this.attends();
  }

  private afterFirst(): void {
    // By the next picture the first one is on the screen.
    requestAnimationFrame(() => {
      this.stats.firstMs = performance.now();
      this.room.cull();
      if (!this.isPlain) void this.enrich();
    });
  }

  private draw(): void {
    const { renderer, scene, room, cameras, stats } = this;
    if (!this.isFull) this.room.relight();
    else if (this.shadowsLate) {
      this.lights.refresh();
      this.shadowsLate = false;
    }
    this.figure.prepare(cameras.kind !== "eyes");
    // The room puts what moves in it where it is by itself.
    for (const part of scene.children) if (part !== room.group) part.updateMatrixWorld();
    renderer.info.reset();
    renderer.render(scene, cameras.camera);
    stats.calls = renderer.info.render.calls;
    stats.triangles = renderer.info.render.triangles;
    for (const listener of this.afterwards) listener();
  }

  close(): void {
    cancelAnimationFrame(this.running);
    this.renderer.dispose();
  }
}
