// What she sees: the picture from her eyes, and the object in it that the pointer is on.

import { el, fill, write } from "../dom.ts";
import { ownAddress } from "../server.ts";
import type { Show } from "../show.ts";
import type { Seen } from "./conversation.ts";
import { spoken } from "./words.ts";

export interface FrameView {
  root: HTMLElement;
  show: (seen: Seen | null) => void;
  seen: () => Seen | null;
  picture: HTMLElement;
}

type Box = readonly [number, number, number, number];

/** The smallest box that holds a point: what is in front is mostly the smaller one. */
export function boxAt<T extends { box: Box }>(objects: readonly T[], u: number, v: number): T | undefined {
  return objects
    .filter(({ box }) => u >= box[0] - 3 && u < box[2] + 3 && v >= box[1] - 3 && v < box[3] + 3)
    .sort((a, b) => area(a.box) - area(b.box))[0];
}

const area = (box: Box): number => (box[2] - box[0]) * (box[3] - box[1]);

export function buildFrame(show: Show): FrameView {
  const image = el("img", { attr: { alt: "", decoding: "async" } });
  const mark = el("div", { class: "mark" });
  const tip = el("div", { class: "tip", attr: { hidden: "" } });
  const empty = el("div", { class: "empty" }, "She has not looked yet");
  const picture = el("div", { class: "frame" }, image, mark, tip, empty);
  const tags = el("div", { class: "tags", role: "group", attr: { "aria-label": "Objects in view" } });
  const step = el("small");
  const root = el("section", { class: "sees mind-part", attr: { "aria-label": "What she sees" } }, el("h2", {}, "Sees", step), picture, tags);
  let now: Seen | null = null;

  const light = (): void => {
    const object = now?.view.objects.find((item) => item.tag === show.bright);
    mark.classList.toggle("bright", object !== undefined);
    tip.hidden = !object;
    for (const tag of tags.children) tag.classList.toggle("bright", (tag as HTMLElement).dataset.tag === show.bright);
    if (!object || !now) return;
    const [left, top, right, bottom] = object.box;
    const x = (value: number): string => `${(100 * value) / (now?.view.width_px ?? 1)}%`;
    const y = (value: number): string => `${(100 * value) / (now?.view.height_px ?? 1)}%`;
    mark.style.left = x(left);
    mark.style.top = y(top);
    mark.style.width = x(right - left);
    mark.style.height = y(bottom - top);
    write(tip, spoken(object.tag));
    const isLow = top / now.view.height_px < 0.14;
    tip.style.left = `${Math.min(80, (100 * left) / now.view.width_px)}%`;
    tip.style.top = isLow ? y(bottom + 4) : `calc(${y(top)} - 26px)`;
  };
  show.pointed.listen(light);

  picture.addEventListener("pointermove", (event) => {
    if (!now) return;
    const area = picture.getBoundingClientRect();
    const u = ((event.clientX - area.left) / area.width) * now.view.width_px;
    const v = ((event.clientY - area.top) / area.height) * now.view.height_px;
    show.point(boxAt(now.view.objects, u, v)?.tag ?? "");
  });
  picture.addEventListener("pointerleave", () => show.point(""));

  const render = (seen: Seen | null): void => {
    if (seen === now) return;
    now = seen;
    empty.hidden = seen !== null;
    image.hidden = seen === null;
    if (!seen) return;
    picture.style.aspectRatio = `${seen.view.width_px} / ${seen.view.height_px}`;
    const url = ownAddress(seen.frame);
    if (url && image.src !== url) image.src = url;
    image.alt = `The view from her eyes with ${seen.view.objects.length} objects`;
    write(step, `${seen.view.objects.length} objects in view`);
    fill(tags, ...seen.view.objects.map((object) => tagButton(show, object.tag)));
    light();
  };
  return { root, show: render, seen: () => now, picture };
}

/** A tag that lights its object up in frame and room, with pointer and keyboard alike. */
export function tagButton(show: Show, tag: string): HTMLButtonElement {
  const button = el("button", { class: "tag", type: "button" }, spoken(tag));
  button.dataset.tag = tag;
  button.addEventListener("pointerenter", () => show.point(tag));
  button.addEventListener("pointerleave", () => show.point(""));
  button.addEventListener("focus", () => show.point(tag));
  button.addEventListener("blur", () => show.point(""));
  return button;
}
