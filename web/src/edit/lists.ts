// Beside the room: what is wrong, what can be added, what is there, and the light.

import { el, fill, write } from "../dom.ts";
import type { Checking } from "./checking.ts";
import { ambientField, lightField } from "./chosen.ts";
import type { Field } from "./controls.ts";
import { type Draft, MOST_LIGHTS } from "./draft.ts";
import { assetWords, type Catalog, type Finding, isSame, nameOf, type Ref, type SceneData, targetOf, type Two } from "./scene.ts";
import { freeSpot, levels, pieceOf } from "./support.ts";

/** Each finding leads to the thing that it names. */
export function buildFindings(draft: Draft, checking: Checking, lead: (ref: Ref) => void): HTMLElement {
  const state = el("p", { class: "quiet", role: "status" });
  const found = el("ul", { class: "findings" });
  const update = (): void => {
    root.setAttribute("aria-busy", String(checking.isBusy));
    if (checking.isBusy) return; // What was found stays until more is known.
    const count = checking.findings.length;
    write(state, checking.problem || (count === 0 ? "Nothing is wrong." : count === 1 ? "One finding" : `${count} findings`));
    fill(found, ...checking.findings.map((finding) => row(finding, draft.data, lead)));
  };
  const root = el("section", { attr: { "aria-label": "Findings" } }, el("h2", {}, "Check"), state, found);
  checking.changes.listen(update);
  update();
  return root;
}

function row(finding: Finding, data: SceneData, lead: (ref: Ref) => void): HTMLElement {
  const ref = targetOf(finding.where, data);
  const words = [
    el("strong", {}, (ref && nameOf(data, ref)) || finding.where),
    el("span", {}, finding.problem),
    finding.fix ? el("small", {}, finding.fix) : null,
  ];
  const looks = { class: `finding ${finding.severity}` };
  if (!ref) return el("li", {}, el("div", looks, ...words));
  return el("li", {}, el("button", { ...looks, type: "button", on: { click: () => lead(ref) } }, ...words));
}

/** Where a new object goes: on what is selected, else on the floor near the middle of the picture. */
function addObject(draft: Draft, catalog: Catalog, asset: string, middle: () => Two): void {
  const { data, selected } = draft;
  const all = levels(data, catalog);
  const owner =
    selected?.kind === "furniture" ? data.furniture[selected.index]?.name : selected?.kind === "objects" ? data.objects[selected.index]?.on : "";
  const level = all.find(({ support }) => support === owner || pieceOf(support) === owner) ?? all[0];
  if (!level) return;
  const wish: Two = level === all[0] ? middle() : [level.center[0], level.center[1]];
  draft.addObject(asset, level.support, freeSpot(data, catalog, asset, level, wish));
}

/** Everything that can be added. */
export function buildPalette(draft: Draft, catalog: Catalog, middle: () => Two): HTMLElement {
  const chips = (names: Iterable<string>, add: (asset: string) => void): HTMLElement =>
    el(
      "div",
      { class: "chips" },
      ...[...names].map((name) =>
        el("button", { class: "button small", type: "button", attr: { "aria-label": `Add ${assetWords(name)}` }, on: { click: () => add(name) } }, assetWords(name)),
      ),
    );
  const group = (words: string, content: HTMLElement): HTMLElement => el("details", {}, el("summary", {}, words), content);
  const light = el("button", { class: "button small", type: "button", on: { click: () => draft.addLight(middle()) } }, "Add a light");
  draft.changes.listen(() => {
    light.disabled = draft.data.lights.length >= MOST_LIGHTS;
  });
  const area = el("button", { class: "button small", type: "button", on: { click: () => draft.addArea(middle()) } }, "Add an area");
  return el(
    "section",
    { attr: { "aria-label": "Add" } },
    el("h2", {}, "Add"),
    group("Objects", chips(catalog.objects.keys(), (name) => addObject(draft, catalog, name, middle))),
    group("Furniture", chips(catalog.furniture.keys(), (name) => draft.addFurniture(name, middle()))),
    el("div", { class: "row" }, area, light),
  );
}

const KINDS: readonly [Exclude<Ref["kind"], "agent">, string][] = [
  ["furniture", "Furniture"],
  ["objects", "Objects"],
  ["areas", "Areas"],
  ["lights", "Lights"],
];

/** Everything that is there. */
export function buildThings(draft: Draft, lead: (ref: Ref) => void): HTMLElement {
  const body = el("div");
  let shown = "";
  let rows: [Ref, HTMLButtonElement][] = [];
  const button = (ref: Ref): HTMLElement => {
    const made = el("button", { type: "button", on: { click: () => lead(ref) } }, nameOf(draft.data, ref));
    rows.push([ref, made]);
    return el("li", {}, made);
  };
  const update = (): void => {
    const { data, selected } = draft;
    const names = KINDS.map(([kind]) => data[kind].map((_, index) => nameOf(data, { kind, index })));
    if (JSON.stringify(names) !== shown) {
      shown = JSON.stringify(names);
      rows = [];
      const groups = KINDS.filter(([kind]) => data[kind].length).flatMap(([kind, words]) => [
        el("h3", {}, words),
        el("ul", { class: "things" }, ...data[kind].map((_, index) => button({ kind, index }))),
      ]);
      fill(body, el("ul", { class: "things" }, button({ kind: "agent", index: 0 })), ...groups);
    }
    for (const [ref, made] of rows) made.setAttribute("aria-pressed", String(isSame(ref, selected)));
  };
  draft.changes.listen(update);
  update();
  return el("section", { attr: { "aria-label": "In the room" } }, el("h2", {}, "In the room"), body);
}

/** How bright it is. */
export function buildLight(draft: Draft): HTMLElement {
  const body = el("div", { class: "fields" });
  let made: Field[] = [];
  const update = (): void => {
    const { lights } = draft.data;
    if (made.length !== lights.length + 1) {
      made = [ambientField(draft), ...lights.map((_, index) => lightField(draft, index))];
      fill(body, ...made.map(({ root }) => root));
    }
    for (const field of made) field.update();
  };
  draft.changes.listen(update);
  update();
  return el("section", { attr: { "aria-label": "Light" } }, el("h2", {}, "Light"), body);
}
