// The story of a track: what was said, and every turn with its note, its calls and the feedback on them.

import { el, fill } from "../dom.ts";
import { ownAddress } from "../server.ts";
import type { Show } from "../show.ts";
import type { Deed, Item, SaidItem, TurnItem } from "./conversation.ts";
import { tagButton } from "./frame.ts";
import { callCode, callWords, clock } from "./words.ts";

const OUTCOMES: Record<string, string> = {
  done: "Done",
  corrected: "Corrected",
  refused: "Refused",
  left_out: "Left out",
  waiting: "",
};
const LONG = 260;

/** Text in which the tags of objects can be pointed at. */
export function withTags(show: Show, text: string): (Node | string)[] {
  const tags = show.hello.scene.objects.map((object) => object.tag).filter((tag) => tag.length > 1);
  const known = new Set(tags);
  return text.split(/([A-Za-z]+_\d+)/).map((part) => (known.has(part) ? tagButton(show, part) : part));
}

/** "Done: walked..." begins with what the colour says already. */
function bare(deed: Deed): string {
  const head = `${OUTCOMES[deed.outcome] ?? ""}:`;
  const text = deed.text.startsWith(head) ? deed.text.slice(head.length).trim() : deed.text;
  return text.charAt(0).toUpperCase() + text.slice(1);
}

function deedView(show: Show, deed: Deed): HTMLElement {
  const { name, arguments: args } = deed.call;
  const kind = deed.outcome in OUTCOMES ? deed.outcome : "corrected";
  const feedback = deed.text || deed.outcome !== "waiting";
  return el(
    "div",
    { class: `deed ${kind}` },
    el("strong", {}, callWords(name, args, show.hello.scene)),
    el("code", {}, callCode(name, args)),
    feedback && el("p", {}, el("b", {}, OUTCOMES[kind] ?? ""), " ", ...withTags(show, bare(deed))),
  );
}

function turnView(show: Show, turn: TurnItem, number: number): HTMLElement {
  const title = el("button", { type: "button", title: "Go to this moment" }, `Turn ${number}`);
  title.addEventListener("click", () => show.player.seek(turn.t));
  const view = el(
    "article",
    { class: "turn" },
    el("header", {}, title, el("span", {}, effort(turn)), el("span", {}, clock(turn.t))),
  );
  if (turn.note) {
    const note = el("p", { class: "note" }, ...withTags(show, turn.note));
    view.append(note);
    if (turn.note.length > LONG) {
      note.classList.add("long");
      const more = el("button", { class: "more-button", type: "button" }, "Show all");
      more.addEventListener("click", () => {
        const isLong = note.classList.toggle("long");
        more.textContent = isLong ? "Show all" : "Show less";
      });
      view.append(more);
    }
  }
  if (turn.unreadable) view.append(el("p", { class: "note" }, `Not readable: ${turn.unreadable}`));
  // What she only says is shown as what she says.
  view.hidden = !turn.note && !turn.unreadable && !turn.deeds.length;
  for (const deed of turn.deeds) view.append(deedView(show, deed));
  for (const frame of turn.closeUps) {
    const url = ownAddress(frame);
    if (url) view.append(el("img", { class: "close-up", attr: { src: url, alt: "What she looked at closely", loading: "lazy" } }));
  }
  return view;
}

function effort(turn: TurnItem): string {
  const time = turn.seconds >= 0.05 ? `thought for ${turn.seconds.toFixed(1)} s` : "";
  return [time, turn.messages ? `read ${turn.messages} messages` : ""].filter(Boolean).join(", ");
}

function saidView(show: Show, item: SaidItem): HTMLElement {
  if (item.kind === "note") return el("p", { class: "aside" }, item.text);
  const hers = item.kind !== "said";
  return el(
    "div",
    { class: `said ${hers ? "hers" : ""} ${item.kind === "question" ? "question" : ""}` },
    el("span", { class: "unseen" }, hers ? "She says: " : "You said: "),
    ...(hers ? withTags(show, item.text) : [item.text]),
    item.reason && el("small", {}, item.reason),
  );
}

export interface TurnList {
  root: HTMLElement;
  /** Bring the list up to the story and to the time that is shown. */
  update: () => void;
}

export function buildTurns(show: Show): TurnList {
  const list = el("div", { class: "turns", attr: { tabindex: "0", role: "log", "aria-label": "Turns", "aria-live": "off" } });
  const count = el("small");
  const root = el("section", { class: "story", attr: { "aria-label": "What she thinks and does" } }, el("h2", {}, "Thinks and does", count), list);
  let version = -1;
  let current = -2;
  let views: HTMLElement[] = [];

  const rebuild = (): void => {
    version = show.story.version;
    let number = 0;
    views = show.story.items.map((item) =>
      item.kind === "turn" ? turnView(show, item, ++number) : saidView(show, item),
    );
    count.textContent = number ? `${number} turn${number === 1 ? "" : "s"}` : "";
    if (!views.length) views = [el("p", { class: "aside" }, "Nothing has been said yet. Tell her what to do.")];
    fill(list, ...views);
    current = -2;
  };

  const follow = (): void => {
    const { items } = show.story;
    const time = show.player.following ? Infinity : show.player.time + 0.001;
    const last = items.findLastIndex((item: Item) => item.t <= time);
    if (last === current) return;
    current = last;
    const turn = items.findLastIndex((item, i) => i <= last && item.kind === "turn");
    views.forEach((view, i) => {
      view.classList.toggle("future", items.length > 0 && i > last);
      view.classList.toggle("now", i === turn && i === last);
    });
    const view = views[Math.max(0, last)];
    if (view) {
      const low = view.offsetTop - list.offsetTop + Math.min(view.offsetHeight, list.clientHeight) - list.clientHeight + 14;
      list.scrollTop = Math.max(0, low);
    }
  };

  const update = (): void => {
    if (version !== show.story.version) rebuild();
    follow();
  };
  update();
  return { root, update };
}
