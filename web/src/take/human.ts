// Take part: be the mind. The four tools by clicking in the room or in the picture from her eyes.

import { el, write } from "../dom.ts";
import { spoken } from "../mind/words.ts";
import { boxAt, type FrameView } from "../mind/frame.ts";
import type { Said } from "../protocol.ts";
import type { Show } from "../show.ts";
import type { Hit } from "../view/pointing.ts";

export type Tool = "Auto" | "Look" | "Walk" | "Pick" | "Drop";
const TOOLS: readonly Tool[] = ["Auto", "Look", "Walk", "Pick", "Drop"];
const LEVEL = 0.8;
const FLOOR_M = 0.06;

type Act = Extract<Said, { type: "act" }>;

export interface Aim {
  /** Tag of the thing that is pointed at; empty for none. */
  tag: string;
  x: number;
  y: number;
  z: number;
  isLevel: boolean;
}

/** What a click does with a tool; null for nothing. `held` is the tag of what is in the hand. */
export function actFor(tool: Tool, aim: Aim, held: string): Act | null {
  const [x, y, z] = [aim.x, aim.y, aim.z].map((value) => Number(value.toFixed(3)));
  const isFloor = aim.isLevel && aim.z < FLOOR_M;
  const chosen = tool === "Auto" ? automatic(aim, held, isFloor) : tool;
  switch (chosen) {
    case "Pick":
      return aim.tag ? { type: "act", name: "Pick", arguments: { object: aim.tag } } : null;
    case "Drop":
      return held ? { type: "act", name: "Drop", arguments: { object: held, x, y, z } } : null;
    case "Walk":
      return { type: "act", name: "Walk", arguments: { x, y, z: 0 } };
    default:
      return { type: "act", name: "Look", arguments: { x, y, z } };
  }
}

function automatic(aim: Aim, held: string, isFloor: boolean): Tool {
  if (aim.tag && !held) return "Pick";
  if (isFloor) return "Walk";
  return held && aim.isLevel ? "Drop" : "Look";
}

export class Human {
  readonly root: HTMLElement;
  tool: Tool = "Auto";
  private readonly hint = el("p", { class: "lead" });

  constructor(private readonly show: Show) {
    const bar = el("div", { class: "pick", role: "group", attr: { "aria-label": "Tool" } });
    const buttons = TOOLS.map((tool) => {
      const button = el("button", { type: "button", attr: { "aria-pressed": String(tool === this.tool) } }, tool);
      button.addEventListener("click", () => {
        this.tool = tool;
        buttons.forEach((other, i) => other.setAttribute("aria-pressed", String(TOOLS[i] === tool)));
        this.update();
      });
      bar.append(button);
      return button;
    });
    const answer = el("input", { type: "text", id: "human-answer", attr: { placeholder: "What you tell the user at the end", maxlength: "2000" } });
    const done = el("button", { class: "button", type: "submit" }, "Finish");
    const label = el("label", { class: "unseen", for: "human-answer" }, "Final answer");
    const form = el("form", { class: "row" }, label, answer, done);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      if (show.say({ type: "finish", answer: answer.value.trim() || "Done." })) answer.value = "";
    });
    this.root = el("section", { class: "ask talk-part", attr: { "aria-label": "You are the mind" } }, el("h2", {}, "You are the mind"), this.hint, bar, form);
    show.changes.listen(() => this.update());
    this.update();
  }

  get isTurn(): boolean {
    return this.show.may("act") && this.show.doing === "waiting_for_you";
  }

  private held(): string {
    const id = this.show.track.at(this.show.player.time)?.held;
    return this.show.hello.scene.objects.find((object) => object.id === id)?.tag ?? "";
  }

  private update(): void {
    const held = this.held();
    const hand = held ? `You hold ${spoken(held)}. ` : "";
    const words =
      this.tool === "Auto"
        ? "Click the floor to walk, a thing to take it, a surface to put it down, a wall to look there."
        : `Click where to use ${this.tool}.`;
    write(this.hint, this.isTurn ? hand + words : "Say first what is to be done; then act.");
  }

  /** A click in the room. */
  click(hit: Hit): void {
    if (!this.isTurn) return;
    const object = this.show.hello.scene.objects.find(({ id }) => id === hit.objectId);
    const { x, y, z } = hit.point;
    this.act({ tag: object?.tag ?? "", x, y, z, isLevel: hit.normal.z > LEVEL });
  }

  private act(aim: Aim): void {
    const act = actFor(this.tool, aim, this.held());
    if (act) this.show.say(act);
  }

  /** A click in the picture from her eyes: a box is its object, elsewhere counts the nearest reference point. */
  listenTo(frame: FrameView): void {
    frame.picture.addEventListener("click", (event) => {
      const seen = frame.seen();
      if (!seen || !this.isTurn) return;
      const area = frame.picture.getBoundingClientRect();
      const u = ((event.clientX - area.left) / area.width) * seen.view.width_px;
      const v = ((event.clientY - area.top) / area.height) * seen.view.height_px;
      const object = boxAt(seen.view.objects, u, v);
      if (object) {
        this.act({ tag: object.tag, ...object.position, isLevel: false });
        return;
      }
      const far = (pixel: readonly [number, number]): number => Math.hypot(pixel[0] - u, pixel[1] - v);
      const nearest = [...seen.view.points].sort((a, b) => far(a.pixel) - far(b.pixel))[0];
      if (nearest) this.act({ tag: "", ...nearest.position, isLevel: nearest.position.z < FLOOR_M });
    });
  }
}
