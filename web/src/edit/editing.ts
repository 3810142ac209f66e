// Puts the scene editor on the page.

import { el, write } from "../dom.ts";
import { type Shell, setBadge } from "../shell/shell.ts";
import { Checking } from "./checking.ts";
import { buildChosen } from "./chosen.ts";
import { Draft } from "./draft.ts";
import { listenToEditKeys, takeHold } from "./hands.ts";
import { Keeping } from "./keeping.ts";
import { buildFindings, buildLight, buildPalette, buildThings } from "./lists.ts";
import { Picture } from "./picture.ts";
import { checkScene, getCatalog, getScene } from "./remote.ts";
import type { Catalog, Ref, SceneData, Two } from "./scene.ts";
import { buildBar } from "./saving.ts";

const HELP = "The room in 3D. Drag to turn, scroll to zoom. Of what is selected: arrows nudge it, R turns it, Delete removes it.";

/** What the editor begins with. */
export async function loadEdit(scene: string): Promise<{ data: SceneData; catalog: Catalog }> {
  const [data, catalog] = await Promise.all([getScene(scene), getCatalog()]);
  return { data, catalog };
}

export function edit(shell: Shell, scene: string, data: SceneData, catalog: Catalog): { close: () => void } {
  const draft = new Draft(data);
  const keeping = new Keeping(scene, draft);
  const canvas = el("canvas", { attr: { tabindex: "0", role: "img", "aria-label": HELP } });
  const loading = el("div", { class: "loading" }, el("span", {}, "Opening the scene"));
  const picture = new Picture(canvas, draft, catalog);
  const stage = el("section", { class: "stage", attr: { "aria-label": "Room" } }, canvas, picture.overlay.root, loading);
  const checking = new Checking(draft, checkScene);
  const lead = (ref: Ref): void => {
    draft.select(ref);
    picture.lead(ref);
  };
  const middle = (): Two => [picture.orbit.target.x, picture.orbit.target.y];
  const panel = el(
    "div",
    { class: "card editor" },
    buildChosen(draft, catalog),
    buildFindings(draft, checking, lead),
    buildPalette(draft, catalog, middle),
    buildThings(draft, lead),
    buildLight(draft),
  );
  shell.work.className = "work editing";
  shell.work.replaceChildren(el("div", { class: "left" }, stage, buildBar(draft, scene, (now) => keeping.saved(now))), panel);
  write(shell.where, `Editing ${data.title || data.name}`);
  setBadge(shell.badge, keeping.isBack ? "Your edits are back" : "Editor", "");
  draft.changes.listen(() => {
    // What had the focus may be gone with what was removed.
    if (!draft.selected && document.activeElement === document.body) canvas.focus({ preventScroll: true });
  });
  takeHold(canvas, picture, draft, catalog);
  const deaf = listenToEditKeys(draft, picture);
  const watch = new ResizeObserver(() => picture.resize());
  watch.observe(stage);
  void picture.open(scene).then(() => loading.remove());
  if (new URLSearchParams(location.search).has("debug")) Object.assign(globalThis, { editor: { draft, picture } });
  return {
    close: () => {
      deaf();
      watch.disconnect();
      checking.close();
      picture.close();
    },
  };
}
