// The time line: play, step, speed, and where in the track one is.

import { el, fill, icon, ICONS, write } from "../dom.ts";
import { clock } from "../mind/words.ts";
import type { Show } from "../show.ts";
import { SPEEDS } from "../track/player.ts";

export interface Timeline {
  root: HTMLElement;
  /** Show the time; cheap, for every picture. */
  update: () => void;
}

export function buildTimeline(show: Show): Timeline {
  const { player, track } = show;
  const play = el("button", { class: "button square", type: "button", on: { click: () => player.toggle() } });
  const back = square("Step back", ICONS.back, () => player.step(-1));
  const on = square("Step on", ICONS.on, () => player.step(1));
  const slider = el("input", { type: "range", attr: { min: "0", max: "1000", step: "1", "aria-label": "Time" } });
  const marks = el("div", { class: "marks", attr: { "aria-hidden": "true" } });
  const time = el("output");
  const now = el("button", { class: "button small", type: "button", on: { click: () => player.catchUp() } }, "Now");
  const speed = el("select", { attr: { "aria-label": "Speed" } });
  for (const factor of SPEEDS) speed.append(el("option", { attr: { value: String(factor) } }, `${factor} x`));
  speed.value = "1";
  speed.addEventListener("change", () => {
    const factor = Number(speed.value);
    player.setSpeed(factor);
    if (show.may("speed")) show.say({ type: "speed", factor });
  });
  const span = (): number => Math.max(0.001, track.end - track.start);
  slider.addEventListener("input", () => player.seek(track.start + (Number(slider.value) / 1000) * span()));
  const line = el("div", { class: "line" }, slider, marks);
  let marked = -1;
  const shown = { value: -1, words: "" };

  const mark = (): void => {
    const key = track.events.length + Math.round(track.end * 4) * 1e5;
    if (key === marked) return;
    marked = key;
    const found = track.events.flatMap(({ event, t }) => {
      const kind = event.type === "started" ? "asked" : event.type === "acted" ? event.outcome : "";
      if (!kind) return [];
      const tick = el("i");
      if (["asked", "done", "corrected", "refused"].includes(kind)) tick.className = kind;
      tick.style.left = `${(100 * (t - track.start)) / span()}%`;
      return [tick];
    });
    fill(marks, ...found);
  };

  const state = (): void => {
    const moves = player.following || player.playing;
    fill(play, icon(moves ? ICONS.pause : ICONS.play));
    play.setAttribute("aria-label", moves ? "Pause" : "Play");
    now.hidden = !show.hello.live || player.following;
  };
  player.onChange(state);
  state();

  const update = (): void => {
    mark();
    const value = Math.round((1000 * (player.time - track.start)) / span());
    if (value !== shown.value && (document.activeElement !== slider || player.playing || player.following)) {
      slider.value = String(value);
      shown.value = value;
    }
    const words = `${clock(player.time)} / ${clock(track.end)}`;
    if (words === shown.words) return;
    shown.words = words;
    write(time, words);
    slider.setAttribute("aria-valuetext", words);
  };
  const root = el("div", { class: "time", role: "group", attr: { "aria-label": "Time line" } }, back, play, on, line, time, now, speed);
  return { root, update };
}

function square(words: string, path: string, act: () => void): HTMLButtonElement {
  const looks = { class: "button square", type: "button", title: words, attr: { "aria-label": words } };
  return el("button", { ...looks, on: { click: act } }, icon(path));
}
