// Below the room: what she does now, the box to talk, Stop and Undo.

import { el, icon, ICONS, write } from "../dom.ts";
import { spentWords } from "../mind/words.ts";
import type { Doing } from "../protocol.ts";
import { approvalTick } from "../take/approve.ts";
import type { Show } from "../show.ts";

const DOING: Record<Doing, string> = {
  idle: "Ready",
  seeing: "Looking",
  thinking: "Thinking",
  acting: "Acting",
  asking: "Waits for your approval",
  waiting_for_you: "Your turn",
  closed: "The room is closed",
};
const BUSY: readonly Doing[] = ["seeing", "thinking", "acting"];

export interface Desk {
  root: HTMLElement;
  talkBox: HTMLInputElement | null;
  update: () => void;
}

export function buildDesk(show: Show, timeline: HTMLElement, speech: HTMLElement | null): Desk {
  const dot = el("span", { class: "dot", attr: { "aria-hidden": "true" } });
  const doing = el("span", { attr: { "aria-live": "polite" } });
  const spent = el("span", { class: "spent" });
  const state = el("div", { class: "state" }, dot, doing, spent);
  const talk = show.hello.live ? talkRow(show, speech) : null;
  timeline.classList.add("room-part");
  const tick = show.may("approval") && !show.may("act") ? approvalTick(show) : null;
  const root = el("section", { class: "desk card", attr: { "aria-label": "Talk and time" } }, state, talk?.form, tick, timeline);

  const update = (): void => {
    const now = show.doing;
    const isOff = show.hello.live && !show.connected && now !== "closed";
    write(doing, isOff ? "Connecting to the room" : show.hello.live ? DOING[now] : replayWords(show));
    dot.classList.toggle("busy", BUSY.includes(now) || isOff);
    const { input_tokens = 0, output_tokens = 0, usd = null } = show.status?.spent ?? {};
    write(spent, spentWords([input_tokens, output_tokens], usd));
    talk?.update();
  };
  show.changes.listen(update);
  update();
  return { root, talkBox: talk?.box ?? null, update };
}

function replayWords(show: Show): string {
  const now = show.doing;
  return now === "idle" || now === "closed" ? "Replay" : `Replay: ${DOING[now].toLowerCase()}`;
}

function talkRow(show: Show, speech: HTMLElement | null): { form: HTMLElement; box: HTMLInputElement; update: () => void } {
  const looks = { type: "text", id: "talk-box" };
  const attr = { placeholder: "Tell her what to do", autocomplete: "off", maxlength: "2000", enterkeyhint: "send" };
  const box = el("input", { ...looks, attr });
  const send = el("button", { class: "button main", type: "submit" }, icon(ICONS.send), "Say");
  const stop = el("button", { class: "button danger", type: "button" }, icon(ICONS.stop), "Stop");
  const undo = el("button", { class: "button", type: "button" }, icon(ICONS.undo), "Undo");
  stop.addEventListener("click", () => show.say({ type: "stop" }));
  undo.addEventListener("click", () => show.say({ type: "undo" }));
  const label = el("label", { class: "unseen", for: "talk-box" }, "Tell her what to do");
  const form = el("form", { class: "talk talk-part" }, label, box, speech, send, stop, undo);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const text = box.value.trim();
    if (!text) return;
    if (show.say({ type: "say", text })) {
      box.value = "";
      show.player.catchUp();
    }
  });
  const update = (): void => {
    const now = show.doing;
    const isBusy = [...BUSY, "asking", "waiting_for_you"].includes(now);
    box.disabled = send.disabled = !show.connected || now === "closed" || !show.may("say");
    stop.disabled = !show.connected || !isBusy || !show.may("stop");
    undo.disabled = !show.connected || !show.status?.can_undo || !show.may("undo");
    const asked = show.story.items.at(-1)?.kind === "question";
    box.placeholder = asked ? "Answer her" : isBusy ? "Correct her, or tell her more" : "Tell her what to do";
  };
  return { form, box, update };
}
