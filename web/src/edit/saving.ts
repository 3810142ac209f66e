// The editor's bar: undo and redo, a title and a name, save, and then a room in it.

import { el, icon, ICONS, write } from "../dom.ts";
import { openStart, problemLine, tellProblem } from "../shell/start.ts";
import { textField } from "./controls.ts";
import type { Draft } from "./draft.ts";
import { saveScene } from "./remote.ts";
import type { SceneData } from "./scene.ts";

const NAME = "[a-z0-9][a-z0-9_\\-]{0,40}";
const FILE = /^(.+)\.toml$/;

/**
 * @param scene What is edited; the name of one's own scene stays, others get a new one.
 * @param kept Is told what was saved.
 */
export function buildBar(draft: Draft, scene: string, kept: (data: SceneData) => void): HTMLElement {
  const own = FILE.exec(scene)?.[1] ?? "";
  const mine = new Set(own ? [own] : []);
  let saved: { data: SceneData; scene: string } | null = null;
  const step = (words: string, path: string, act: () => void): HTMLButtonElement =>
    el("button", { class: "button square", type: "button", title: words, attr: { "aria-label": words }, on: { click: act } }, icon(path));
  const undo = step("Undo the edit", ICONS.undo, () => draft.undo());
  const redo = step("Redo the edit", ICONS.undo, () => draft.redo());
  redo.classList.add("mirrored");
  const title = textField(draft, "Title", 200, () => draft.data.title, (value) =>
    draft.edit((data) => {
      data.title = value;
    }, "title"),
  );
  const name = el("input", {
    type: "text",
    id: "edit-file",
    attr: { required: "", maxlength: "41", pattern: NAME, title: "Small letters, digits, - and _", value: own || "my-room", autocomplete: "off" },
  });
  const save = el("button", { class: "button main", type: "submit" }, "Save");
  const open = el("button", { class: "button", type: "button", attr: { hidden: "" } }, "Open a room here");
  const told = el("p", { class: "quiet", role: "status" });
  const problem = problemLine();
  const nameField = el("div", { class: "field" }, el("label", { for: "edit-file" }, "Save as"), name);
  const root = el("form", { class: "desk card edit-bar" }, el("div", { class: "row" }, undo, redo, title.root, nameField, save, open), told, problem);
  const update = (): void => {
    undo.disabled = !draft.canUndo;
    redo.disabled = !draft.canRedo;
    open.hidden = saved?.data !== draft.data;
    title.update();
    if (open.hidden) write(told, "");
  };
  root.addEventListener("submit", (event) => {
    event.preventDefault();
    const { data } = draft;
    save.disabled = true;
    problem.hidden = true;
    saveScene(data, name.value, mine.has(name.value))
      .then((file) => {
        mine.add(name.value);
        saved = { data, scene: file };
        kept(data);
        update();
        if (!open.hidden) write(told, `Saved as ${file}.`);
      })
      .catch((error: unknown) => tellProblem(problem, error))
      .finally(() => {
        save.disabled = false;
      });
  });
  open.addEventListener("click", () => void openStart(saved?.scene));
  draft.changes.listen(update);
  update();
  return root;
}
