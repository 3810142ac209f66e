// The mind beside the body: what she sees, thinks and does at the moment that is shown.

import { el } from "../dom.ts";
import type { Show } from "../show.ts";
import { lastBefore } from "../track/track.ts";
import { buildFrame, type FrameView } from "./frame.ts";
import { buildTurns } from "./turns.ts";

export interface Mind {
  root: HTMLElement;
  frame: FrameView;
  update: () => void;
}

export function buildMind(show: Show): Mind {
  const frame = buildFrame(show);
  const turns = buildTurns(show);
  const root = el("aside", { class: "mind card story-part", attr: { "aria-label": "Her mind" } }, frame.root, turns.root);
  const update = (): void => {
    const { views } = show.story;
    const index = show.player.following ? views.length - 1 : lastBefore(views, show.player.time + 0.001);
    frame.show(views[index] ?? null);
    turns.update();
  };
  update();
  return { root, frame, update };
}
