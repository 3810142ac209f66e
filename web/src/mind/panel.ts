// The mind beside the body: what she sees, thinks and does at the moment that is shown.

import { el } from "../dom.ts";
import type { Show } from "../show.ts";
import { lastBefore } from "../track/track.ts";
import type { TurnItem } from "./conversation.ts";
import { buildFrame, type FrameView } from "./frame.ts";
import { buildMemory } from "./memory.ts";
import { buildTurns } from "./turns.ts";

export interface Mind {
  root: HTMLElement;
  frame: FrameView;
  update: () => void;
}

export function buildMind(show: Show): Mind {
  const frame = buildFrame(show);
  const memory = buildMemory(show);
  const turns = buildTurns(show);
  const root = el("aside", { class: "mind card story-part", attr: { "aria-label": "Her mind" } }, frame.root, memory.root, turns.root);
  const update = (): void => {
    const { views } = show.story;
    const index = show.player.following ? views.length - 1 : lastBefore(views, show.player.time + 0.001);
    frame.show(views[index] ?? null);
    memory.show(turnAt(show));
    turns.update();
  };
  update();
  return { root, frame, update };
}

/** The last turn that had begun at the time that is shown. */
function turnAt({ player, story }: Show): TurnItem | null {
  const time = player.following ? Infinity : player.time + 0.001;
  return story.items.findLast((item): item is TurnItem => item.kind === "turn" && item.t <= time) ?? null;
}
