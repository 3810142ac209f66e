// What lies over the picture: labels that keep clear of each other, and what she says.

import { type PerspectiveCamera, Vector3 } from "three";
import { el, write } from "../dom.ts";

export interface Label {
  text: string;
  place: Vector3;
  kind: "" | "point";
  bright: boolean;
}

interface Rect {
  x: number;
  y: number;
  w: number;
  h: number;
}

const CHARACTER_PX = 6.9;
const HEIGHT_PX = 20;
const GAP_PX = 2;
const SVG = "http://www.w3.org/2000/svg";

const meets = (a: Rect, b: Rect): boolean =>
  a.x < b.x + b.w + GAP_PX && b.x < a.x + a.w + GAP_PX && a.y < b.y + b.h + GAP_PX && b.y < a.y + a.h + GAP_PX;

/** Where a label can go, the nearest to its anchor first: above, then further up and aside. */
function* spots(x: number, y: number, w: number): Generator<Rect> {
  for (let ring = 0; ring < 7; ring++) {
    const lift = 10 + ring * (HEIGHT_PX + GAP_PX);
    for (const aside of [0, -0.6, 0.6]) yield { x: x - w / 2 + aside * w, y: y - lift - HEIGHT_PX, w, h: HEIGHT_PX };
  }
  for (let ring = 0; ring < 4; ring++) {
    yield { x: x - w / 2, y: y + 10 + ring * (HEIGHT_PX + GAP_PX), w, h: HEIGHT_PX };
  }
}

/** Places labels so that none covers another; those that find no room are left out. */
export function layOut(
  anchors: readonly { x: number; y: number; w: number }[],
  width: number,
  height: number,
): (Rect | null)[] {
  const taken: Rect[] = [];
  return anchors.map(({ x, y, w }) => {
    for (const spot of spots(x, y, w)) {
      const isInside = spot.x >= 2 && spot.y >= 2 && spot.x + w <= width - 2 && spot.y + spot.h <= height - 2;
      if (!isInside || taken.some((other) => meets(spot, other))) continue;
      taken.push(spot);
      return spot;
    }
    return null;
  });
}

export class Overlay {
  readonly root = el("div", { class: "over", attr: { "aria-hidden": "true" } });
  private readonly lines = document.createElementNS(SVG, "svg");
  private readonly labels: HTMLElement[] = [];
  private readonly bubble = el("div", { class: "bubble", attr: { hidden: "" } });
  private readonly size = { w: 0, h: 0 };
  private readonly bubbleSize = { w: 0, h: 0 };
  private used = 0;
  private said = "";

  constructor() {
    this.root.append(this.lines, this.bubble);
    // To ask for a size lays the page out anew: it is asked when it changes, and not for each picture.
    new ResizeObserver(() => {
      [this.size.w, this.size.h] = [this.root.clientWidth, this.root.clientHeight];
      this.measureBubble();
    }).observe(this.root);
  }

  private measureBubble(): void {
    [this.bubbleSize.w, this.bubbleSize.h] = [this.bubble.offsetWidth, this.bubble.offsetHeight];
  }

  private project(place: Vector3, camera: PerspectiveCamera): { x: number; y: number; far: number } | null {
    const at = place.clone().project(camera);
    if (at.z > 1 || at.z < -1 || Math.abs(at.x) > 1 || Math.abs(at.y) > 1) return null;
    const { w, h } = this.size;
    return { x: ((at.x + 1) / 2) * w, y: ((1 - at.y) / 2) * h, far: at.z };
  }

  /** Show labels, the bright ones first, then the near ones. */
  show(labels: readonly Label[], camera: PerspectiveCamera): void {
    if (!labels.length && !this.used) return;
    const seen = labels
      .flatMap((label) => {
        const at = this.project(label.place, camera);
        return at ? [{ label, ...at, w: label.text.length * CHARACTER_PX + 16 }] : [];
      })
      .sort((a, b) => Number(b.label.bright) - Number(a.label.bright) || a.far - b.far);
    const placed = layOut(seen, this.size.w, this.size.h);
    const lines: SVGLineElement[] = [];
    let used = 0;
    seen.forEach(({ label, x, y }, i) => {
      const spot = placed[i];
      if (!spot) return;
      const node = this.labels[used] ?? this.grow();
      used++;
      node.hidden = false;
      node.className = `label ${label.kind} ${label.bright ? "bright" : ""}`;
      write(node, label.text);
      node.style.transform = `translate(${Math.round(spot.x)}px, ${Math.round(spot.y)}px)`;
      node.style.width = `${Math.round(spot.w)}px`;
      node.style.textAlign = "center";
      const below = spot.y > y;
      lines.push(this.line(x, y, spot.x + spot.w / 2, below ? spot.y : spot.y + spot.h));
    });
    for (const node of this.labels.slice(used, this.used)) node.hidden = true;
    this.used = used;
    this.lines.replaceChildren(...lines);
  }

  private grow(): HTMLElement {
    const node = el("div", { class: "label" });
    this.labels.push(node);
    this.root.append(node);
    return node;
  }

  private line(x1: number, y1: number, x2: number, y2: number): SVGLineElement {
    const line = document.createElementNS(SVG, "line");
    for (const [name, value] of Object.entries({ x1, y1, x2, y2 })) line.setAttribute(name, value.toFixed(1));
    return line;
  }

  /** What she says, above her head; empty for nothing. */
  speak(text: string, isQuestion: boolean, crown: Vector3, camera: PerspectiveCamera): void {
    const at = text ? crown.clone().project(camera) : null;
    const isBehind = !at || at.z > 1;
    if (this.bubble.hidden !== isBehind) this.bubble.hidden = isBehind;
    if (isBehind) return;
    if (this.said !== text || !this.bubbleSize.w) {
      this.said = text;
      write(this.bubble, text);
      this.bubble.classList.toggle("question", isQuestion);
      this.measureBubble();
    }
    const { w, h } = this.size;
    const [x, y] = [((at.x + 1) / 2) * w, ((1 - at.y) / 2) * h];
    const { w: bw, h: bh } = this.bubbleSize;
    const left = Math.min(Math.max(10, x - bw / 2), w - bw - 10);
    const top = Math.min(Math.max(54, y - bh - 18), h - bh - 14);
    this.bubble.style.transform = `translate(${Math.round(left)}px, ${Math.round(top)}px)`;
    this.bubble.style.setProperty("--tail", `${Math.min(bw - 22, Math.max(22, x - left))}px`);
  }
}
