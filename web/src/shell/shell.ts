// The page's frame: where everything has its place.

import iconUrl from "../icon.svg?inline"; // So that a page without a server has it too.
import { el, icon, ICONS, write } from "../dom.ts";
import { themeButton } from "./theme.ts";

export interface Shell {
  root: HTMLElement;
  work: HTMLElement;
  where: HTMLElement;
  badge: HTMLElement;
  newButton: HTMLButtonElement;
  runsButton: HTMLButtonElement;
}

type Tab = "mind" | "talk" | "room";
const TABS: readonly [Tab, string][] = [
  ["mind", "Mind"],
  ["talk", "Talk"],
  ["room", "Room"],
];

export function buildShell(app: HTMLElement): Shell {
  const where = el("span");
  const badge = el("span", { class: "badge", attr: { hidden: "" } });
  const newButton = button("New room", ICONS.plus);
  const runsButton = button("Runs", ICONS.list);
  const logo = el("img", { attr: { src: iconUrl, alt: "" } });
  const top = el(
    "header",
    { class: "top" },
    el("h1", { class: "brand" }, logo, "ADAMO studio"),
    el("div", { class: "where" }, where, badge),
    el("nav", { attr: { "aria-label": "Studio" } }, newButton, runsButton, themeButton()),
  );
  const work = el("main", { class: "work" });
  work.dataset.tab = "talk";
  app.replaceChildren(top, work);
  return { root: app, work, where, badge, newButton, runsButton };
}

function button(words: string, path: string): HTMLButtonElement {
  return el(
    "button",
    { class: "button plain small", type: "button", attr: { "aria-label": words } },
    icon(path),
    el("span", { class: "words" }, words),
  );
}

/** On a narrow screen one of mind, talk and room is shown below the picture. */
export function tabs(work: HTMLElement): HTMLElement {
  const buttons = TABS.map(([name, words]) =>
    el("button", { type: "button", role: "tab", id: `tab-${name}`, on: { click: () => choose(name) } }, words),
  );
  const choose = (name: string): void => {
    work.dataset.tab = name;
    TABS.forEach(([tab], i) => {
      buttons[i]?.setAttribute("aria-selected", String(tab === name));
      buttons[i]?.setAttribute("tabindex", tab === name ? "0" : "-1");
    });
  };
  const bar = el("div", { class: "tabs", role: "tablist", attr: { "aria-label": "What is shown" } }, ...buttons);
  bar.addEventListener("keydown", (event) => {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (!step) return;
    const now = TABS.findIndex(([tab]) => tab === work.dataset.tab);
    const next = (now + step + TABS.length) % TABS.length;
    choose(TABS[next]?.[0] ?? "mind");
    buttons[next]?.focus();
    event.stopPropagation();
  });
  choose(work.dataset.tab ?? "talk");
  return bar;
}

export function setBadge(badge: HTMLElement, text: string, kind: "" | "live" | "odd"): void {
  write(badge, text);
  badge.className = `badge ${kind}`;
  badge.hidden = !text;
}
