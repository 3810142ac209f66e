// The room on the page: the picture, its cameras and overlays, and what the pointer does in it.

import { Vector3 } from "three";
import { el, icon, ICONS, write } from "../dom.ts";
import { isQuestion } from "../mind/conversation.ts";
import { readAloud, spoken } from "../mind/words.ts";
import { ownAddress } from "../server.ts";
import type { Show } from "../show.ts";
import type { CameraKind } from "./cameras.ts";
import { BEARINGS } from "./life.ts";
import { Marks } from "./marks.ts";
import { type Label, Overlay } from "./overlay.ts";
import { type Hit, Pointing } from "./pointing.ts";
import { steer } from "./pointer.ts";
import { Stage } from "./stage.ts";

export const CAMERAS: readonly [CameraKind, string, string][] = [
  ["free", "Free", ICONS.orbit],
  ["follow", "Follow", ICONS.follow],
  ["eyes", "Her eyes", ICONS.eye],
];

type Layer = "tags" | "points" | "reach" | "walkable";
const LAYERS: readonly [Layer, string][] = [
  ["tags", "Tags"],
  ["points", "Points"],
  ["reach", "Reach"],
  ["walkable", "Walkable"],
];

const SPOKEN_S = 9;

/** What may be done with the pointer beyond looking; see `take/`. */
export interface Hands {
  grab: (hit: Hit) => boolean;
  drag: (event: PointerEvent) => void;
  release: () => void;
  click: (hit: Hit) => void;
  /** Whether a click does something. */
  aims: () => boolean;
}


export class Seeing {
  readonly root: HTMLElement;
  readonly canvas = el("canvas", { attr: { tabindex: "0", "aria-label": "The room in 3D. Drag to turn, scroll to zoom.", role: "img" } });
  readonly layersBar: HTMLElement;
  readonly overlay = new Overlay();
  stage: Stage | null = null;
  pointing: Pointing | null = null;
  marks: Marks | null = null;
  hands: Hands | null = null;
  private readonly layers = new Set<Layer>();
  private readonly layerPicks: [Layer, HTMLButtonElement][] = [];
  private readonly cameraButtons = new Map<CameraKind, HTMLButtonElement>();
  private readonly loading: HTMLElement;
  private readonly progress = el("progress", { attr: { max: "1", value: "0", "aria-label": "Loading the room" } });
  private readonly stats = el("div", { class: "stats", attr: { hidden: "" } });
  private readonly live = el("div", { class: "unseen", attr: { "aria-live": "polite" } });
  private readonly hint = el("div", { class: "hint", role: "status", attr: { hidden: "" } });
  private shownTime = -1;
  private said = "";
  private hovered = 0;

  constructor(
    private readonly show: Show,
    private readonly everyFrame: () => void,
  ) {
    this.loading = el("div", { class: "loading" }, el("span", {}, "Opening the room"), this.progress);
    this.layersBar = this.layerButtons();
    this.root = el(
      "section",
      { class: "stage", attr: { "aria-label": "Room" } },
      this.canvas,
      this.overlay.root,
      el("div", { class: "corner left-top" }, this.cameraPicks()),
      el("div", { class: "corner right-top" }, this.layersBar),
      this.hint,
      this.stats,
      this.live,
      this.loading,
    );
  }

  async open(): Promise<void> {
    const { hello } = this.show;
    const urls = { scene: ownAddress(hello.scene.glb), figure: ownAddress(hello.figure.glb) };
    if (!urls.scene || !urls.figure) {
      this.failed("This run cannot be shown in 3D. What she saw, thought and did is beside.");
      this.runAlone();
      return;
    }
    const stage = await Stage.open(this.canvas, hello, urls, (s) => this.tick(s), (share) => {
      this.progress.value = share;
    });
    this.stage = stage;
    this.pointing = new Pointing(stage);
    this.marks = new Marks(hello.scene, hello.body, stage.room.voxels);
    stage.scene.add(this.marks.group);
    for (const layer of this.layers) this.showLayer(layer, true);
    stage.attends = () => (hello.live && this.show.player.following ? BEARINGS[this.show.doing] : "busy");
    stage.onDrawn(() => this.drawn());
    this.show.pointed.listen(() => this.light());
    steer(this.canvas, stage.cameras, {
      down: (event) => this.grab(event),
      move: (event) => this.hands?.drag(event),
      up: () => this.hands?.release(),
      click: (event) => this.clicked(event),
      hover: (event) => this.hover(event),
      steered: () => this.pressCamera(),
    });
    new ResizeObserver(() => stage.resize()).observe(this.root);
    stage.resize();
    stage.start();
  }

  /** Without a picture the clock goes on all the same. */
  private runAlone(): void {
    let last = performance.now();
    const loop = (now: number): void => {
      if (!this.root.isConnected) return;
      this.show.player.advance((now - last) / 1000);
      last = now;
      this.everyFrame();
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  private tick(seconds: number): boolean {
    const { player, track } = this.show;
    player.advance(seconds);
    this.everyFrame();
    if (player.time === this.shownTime) return false;
    const moment = track.at(player.time);
    if (!moment || !this.stage) return false;
    if (this.stage.moment === null) this.loading.remove();
    this.shownTime = player.time;
    this.stage.show(moment);
    this.marks?.update(moment);
    this.light(false);
    return true;
  }

  private drawn(): void {
    const { stage } = this;
    if (!stage) return;
    const { camera } = stage.cameras;
    this.overlay.show(this.labels(), camera);
    const said = this.spokenNow();
    if (said !== this.said) write(this.live, said);
    this.said = said;
    this.overlay.speak(stage.cameras.kind === "eyes" ? "" : said, isQuestion(said), stage.figure.crown(), camera);
    if (!this.stats.hidden) write(this.stats, this.statsLine());
  }

  /** What she said just now. */
  private spokenNow(): string {
    const { story, player } = this.show;
    const last = story.items.findLast((item) => item.t <= player.time + 0.01 && item.kind !== "turn" && item.kind !== "note");
    if (!last || last.kind === "turn" || last.kind === "said") return "";
    const isLast = last === story.items.at(-1);
    const tags = this.show.hello.scene.objects.map((object) => object.tag);
    return isLast || player.time - last.t < SPOKEN_S ? readAloud(last.text, tags) : "";
  }

  statsLine(): string {
    const s = this.stage?.stats;
    if (!s) return "";
    const rate = s.frameMs ? 1000 / s.frameMs : 0;
    const triangles = Math.round(s.triangles / 1000);
    return `${rate.toFixed(1)} frames/s · ${s.calls} calls · ${triangles}k triangles · script ${s.scriptMs.toFixed(1)} ms · ${s.pixels} · picture ${s.frames}`;
  }

  private labels(): Label[] {
    const { stage, show } = this;
    const moment = stage?.moment;
    if (!stage || !moment) return [];
    const labels: Label[] = [];
    for (const object of show.hello.scene.objects) {
      const bright = object.tag === show.bright;
      if (!bright && !this.layers.has("tags")) continue;
      const thing = stage.room.things.get(object.id);
      if (!thing || moment.gone.has(object.id)) continue;
      const place = thing.position.clone().add(new Vector3(0, 0, Math.max(...object.size) * 0.3));
      labels.push({ text: spoken(object.tag), place, kind: "", bright });
    }
    if (this.layers.has("points")) {
      const { views } = show.story;
      const view = views.findLast((seen) => seen.t <= show.player.time + 0.01);
      for (const point of view?.view.points ?? []) {
        const { x, y, z } = point.position;
        labels.push({ text: point.tag, place: new Vector3(x, y, z), kind: "point", bright: false });
      }
    }
    return labels;
  }

  private light(touch = true): void {
    const id = this.show.objectOf(this.show.bright);
    this.marks?.outline(id === null ? null : (this.stage?.room.things.get(id) ?? null));
    if (touch) this.stage?.touch();
  }

  private hover(event: PointerEvent): void {
    const now = performance.now();
    if (now - this.hovered < 70 || !this.pointing) return;
    this.hovered = now;
    const hit = this.pointing.at(event);
    const object = this.show.hello.scene.objects.find(({ id }) => id === hit?.objectId);
    this.show.point(object?.tag ?? "");
    this.canvas.classList.toggle("aims", this.hands?.aims() ?? false);
  }

  private grab(event: PointerEvent): boolean {
    const hit = this.hands ? this.pointing?.at(event) : null;
    return hit ? (this.hands?.grab(hit) ?? false) : false;
  }

  private clicked(event: PointerEvent): void {
    const hit = this.pointing?.at(event);
    if (hit) this.hands?.click(hit);
  }

  private cameraPicks(): HTMLElement {
    const bar = el("div", { class: "pick", role: "group", attr: { "aria-label": "Camera" } });
    for (const [kind, words, path] of CAMERAS) {
      const button = el("button", { type: "button", attr: { "aria-pressed": String(kind === "free") } }, icon(path), words);
      button.addEventListener("click", () => this.chooseCamera(kind));
      this.cameraButtons.set(kind, button);
      bar.append(button);
    }
    return bar;
  }

  chooseCamera(kind: CameraKind): void {
    this.stage?.cameras.choose(kind);
    this.stage?.touch();
    this.pressCamera();
  }

  private pressCamera(): void {
    const now = this.stage?.cameras.kind ?? "free";
    for (const [kind, button] of this.cameraButtons) button.setAttribute("aria-pressed", String(kind === now));
  }

  /** The same switches once more for narrow screens, where they have no room over the picture. */
  roomLayers(): HTMLElement {
    const bar = this.layerButtons();
    bar.classList.add("room-part", "narrow");
    return bar;
  }

  private layerButtons(): HTMLElement {
    const bar = el("div", { class: "pick layers", role: "group", attr: { "aria-label": "Show in the room" } });
    for (const [layer, words] of LAYERS) {
      const button = el("button", { type: "button", attr: { "aria-pressed": "false" } }, words);
      button.addEventListener("click", () => {
        const on = !this.layers.has(layer);
        if (on) this.layers.add(layer);
        else this.layers.delete(layer);
        this.pressLayer(layer, on);
        this.showLayer(layer, on);
      });
      this.layerPicks.push([layer, button]);
      bar.append(button);
    }
    return bar;
  }

  private pressLayer(layer: Layer, on: boolean): void {
    for (const [own, button] of this.layerPicks) if (own === layer) button.setAttribute("aria-pressed", String(on));
  }

  private showLayer(layer: Layer, on: boolean): void {
    if (layer === "reach") this.marks?.showReach(on);
    if (layer === "walkable") this.marks?.showWalkable(on);
    this.stage?.touch();
  }

  toggleStats(): void {
    this.stats.hidden = !this.stats.hidden;
    this.stage?.touch();
  }

  /** Tell the user something over the picture; empty takes it away. */
  tell(words: string, isError = false): void {
    write(this.hint, words);
    this.hint.hidden = !words;
    this.hint.classList.toggle("error", isError);
  }

  failed(words: string): void {
    this.loading.replaceChildren(el("p", {}, words));
  }
}
