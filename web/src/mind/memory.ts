// What she had before her when she thought: the state that she was told, and how far back she remembers.

import { el, fill } from "../dom.ts";
import { number } from "../reading.ts";
import type { Show } from "../show.ts";
import type { TurnItem } from "./conversation.ts";
import { withTags } from "./turns.ts";

export interface MemoryView {
  root: HTMLElement;
  /** Show what she remembered in a turn; null for none. */
  show: (turn: TurnItem | null) => void;
}

/** What her memory held, in words. */
export function memoryWords(turn: { messages: number; step: number } | null, k: number): string {
  if (!turn) return "She has not thought yet.";
  const read = turn.messages ? `She read ${turn.messages} message${turn.messages === 1 ? "" : "s"}` : "What she read is not on record";
  return k > 0 ? `${read}. At most the last ${k} steps are kept.` : `${read}.`;
}

export function buildMemory(show: Show): MemoryView {
  const k = number(show.hello.settings.k);
  const words = el("p");
  const state = el("div", { class: "state-text", attr: { tabindex: "0", role: "region", "aria-label": "The state that she was told" } });
  const root = el("details", { class: "memory mind-part" }, el("summary", {}, "Remembers"), words, state);
  let now: TurnItem | null = null;
  let shown: TurnItem | null | undefined;
  const render = (): void => {
    if (!root.open || shown === now) return;
    shown = now;
    words.textContent = memoryWords(now, k);
    state.hidden = !now;
    fill(state, ...(now?.state.trim() ? withTags(show, now.state.trim()) : ["She was told no state in words."]));
    state.scrollTop = 0;
  };
  root.addEventListener("toggle", render);
  return {
    root,
    show: (turn) => {
      now = turn;
      render();
    },
  };
}
