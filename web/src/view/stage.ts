// Draws the room: one renderer, one loop, a picture only when something changed.

import { ACESFilmicToneMapping, BasicShadowMap, Color, PCFShadowMap, Scene, SRGBColorSpace, Vector3, WebGLRenderer } from "three";
import type { Hello } from "../protocol.ts";
import type { Moment } from "../track/track.ts";
import { Cameras } from "./cameras.ts";
import { ContactShadows } from "./contact.ts";
import { Figure } from "./figure.ts";
import { isSoftware, type Lights, lightRoom, surroundings } from "./lights.ts";
import type { Progress } from "./loading.ts";
import { Quality } from "./quality.ts";
import { Room } from "./room.ts";

export interface Stats {
  frames: number;
  frameMs: number;
  scriptMs: number;
  calls: number;
  triangles: number;
  pixels: string;
}

const WARM_FRAMES = 4;
const REFLECTED = 0.8;
/** After so long without a change the picture is drawn sharp. */
const STILL_MS = 350;
/** Where a processor draws, shadows follow this often. */
const SHADOWS_MS = 220;

/** Is called before each picture; returns whether something changed that the picture shows. */
export type Tick = (seconds: number) => boolean;

export class Stage {
  readonly scene = new Scene();
  readonly quality: Quality;
  readonly stats: Stats = { frames: 0, frameMs: 0, scriptMs: 0, calls: 0, triangles: 0, pixels: "" };
  private readonly lights: Lights;
  private readonly contact: ContactShadows;
  private readonly afterwards: (() => void)[] = [];
  private brightness = 1;
  private isSharp = true;
  private drawnAt = 0;
  private shadowsLate = true;
  private shadowsAt = 0;
  private dirty = true;
  private last = 0;
  private drewLast = false;
  private running = 0;
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
    this.lights = lightRoom(hello.scene, room.window, isPlain);
    this.contact = new ContactShadows(hello.scene.objects);
    this.scene.background = new Color(0x1a1714);
    if (!isPlain) {
      this.scene.environment = surroundings(renderer, room.window ?? new Vector3(1, 0, 0));
      this.scene.environmentIntensity = REFLECTED;
    }
    this.scene.add(room.group, figure.group, this.lights.group, this.contact.mesh);
  }

  static async open(
    canvas: HTMLCanvasElement,
    hello: Hello,
    urls: { scene: string; figure: string },
    tick: Tick,
    progress?: Progress,
  ): Promise<Stage> {
    const asked = new URLSearchParams(location.search).get("quality");
    const isPlain = asked ? asked === "plain" : isSoftware();
    const renderer = new WebGLRenderer({ canvas, antialias: !isPlain, powerPreference: "high-performance" });
    renderer.outputColorSpace = SRGBColorSpace;
    renderer.toneMapping = ACESFilmicToneMapping;
    renderer.toneMappingExposure = 1.05;
    renderer.shadowMap.enabled = true;
    // Soft edges cost a processor more than all the rest.
    renderer.shadowMap.type = isPlain ? BasicShadowMap : PCFShadowMap;
    renderer.info.autoReset = false;
    const room = await Room.load(urls.scene, hello.scene, isPlain, progress);
    const figure = await Figure.load(urls.figure, hello.joints, room.ambience, isPlain);
    const cameras = new Cameras(hello.scene, hello.body, room.voxels);
    const stage = new Stage(renderer, hello, room, figure, cameras, tick, isPlain);
    await renderer.compileAsync(stage.scene, cameras.camera);
    return stage;
  }

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
      this.scene.environmentIntensity = REFLECTED * (0.2 + 0.8 * moment.lights);
    }
    this.figure.pose(moment);
    this.contact.update(moment, this.figure);
    if (first) this.cameras.begin(moment);
    this.shadowsLate = true;
    this.dirty = true;
  }

  resize(): void {
    const canvas = this.renderer.domElement;
    const { clientWidth: width, clientHeight: height } = canvas;
    if (!width || !height) return;
    this.setPixels(this.quality.current.pixels);
    this.cameras.resize(width, height);
    this.lights.shadowSize(this.quality.current.shadow);
    this.dirty = true;
  }

  /** Draw with a share of the screen's own pixels. */
  private setPixels(share: number): void {
    const canvas = this.renderer.domElement;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2) * share);
    this.renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
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
    if (this.moment && this.cameras.update(this.moment, this.figure, seconds)) this.dirty = true;
    if (!this.dirty || !this.moment) {
      this.drewLast = false;
      this.sharpen(now);
      return;
    }
    this.dirty = false;
    if (this.isSharp && this.quality.current.pixels < 1) this.setPixels(this.quality.current.pixels);
    this.draw();
    this.drawnAt = now;
    const spent = performance.now() - begin;
    const { stats } = this;
    // The first pictures wait for programs to be compiled: they say nothing about the others.
    if (++stats.frames <= WARM_FRAMES) return;
    stats.scriptMs = stats.scriptMs ? stats.scriptMs * 0.9 + spent * 0.1 : spent;
    if (this.drewLast) {
      stats.frameMs = stats.frameMs ? stats.frameMs * 0.85 + since * 0.15 : since;
      if (this.quality.note(since)) this.resize();
    }
    this.drewLast = true;
  }

  private draw(): void {
    const { renderer, cameras, stats } = this;
    const now = performance.now();
    if (this.shadowsLate && (!this.isPlain || now - this.shadowsAt > Math.max(SHADOWS_MS, this.stats.frameMs * 4))) {
      this.lights.refresh();
      this.shadowsLate = false;
      this.shadowsAt = now;
    }
    this.figure.showHead(cameras.kind !== "eyes");
    renderer.info.reset();
    renderer.render(this.scene, cameras.camera);
    stats.calls = renderer.info.render.calls;
    stats.triangles = renderer.info.render.triangles;
    for (const listener of this.afterwards) listener();
  }

  close(): void {
    cancelAnimationFrame(this.running);
    this.renderer.dispose();
  }
}
