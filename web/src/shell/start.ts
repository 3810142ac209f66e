// The start: which room, who thinks, and what is asked of her.

import { el, fill, icon, ICONS } from "../dom.ts";
import type { Offer } from "../protocol.ts";
import { getOffer, openRoom } from "../server.ts";

export function dialog(title: string, lead: string, ...content: HTMLElement[]): HTMLDialogElement {
  const close = el("button", { class: "button plain square", type: "button", attr: { "aria-label": "Close" } }, icon(ICONS.close));
  const heading = el("div", {}, el("h2", { id: "sheet-title" }, title), el("p", { class: "lead" }, lead));
  const sheet = el("div", { class: "sheet" }, el("header", {}, heading, close), ...content);
  const made = el("dialog", { attr: { "aria-labelledby": "sheet-title" } }, sheet);
  close.addEventListener("click", () => made.close());
  made.addEventListener("close", () => made.remove());
  document.body.append(made);
  made.showModal();
  return made;
}

export function problemLine(): HTMLElement {
  return el("p", { class: "problem", role: "alert", attr: { hidden: "" } });
}

export function tellProblem(line: HTMLElement, error: unknown): void {
  line.textContent = error instanceof Error ? error.message : String(error);
  line.hidden = false;
}

/** Stands for any model of a provider, whose name is asked for. */
const ANY = "NAME";

interface Choice {
  value: string;
  words: string;
  off?: boolean;
}

function choose(label: string, id: string, choices: readonly Choice[], wide = false): [HTMLElement, HTMLSelectElement] {
  const select = el("select", { id });
  setChoices(select, choices);
  return [el("div", { class: wide ? "field wide" : "field" }, el("label", { for: id }, label), select), select];
}

function setChoices(select: HTMLSelectElement, choices: readonly Choice[]): void {
  const before = select.value;
  const options = choices.map(({ value, words, off }) => {
    const option = el("option", { attr: { value } }, words);
    option.disabled = off ?? false;
    return option;
  });
  fill(select, ...options);
  if (choices.some(({ value }) => value === before)) select.value = before;
}

const plain = (values: readonly string[]): Choice[] => values.map((value) => ({ value, words: value }));
const LABELINGS: Record<string, string> = { sem: "Names and numbers", opaq: "Numbers alone" };

function models(offer: Offer): Choice[] {
  return offer.models.map(({ name, note, needs_key, has_key }) => {
    const off = needs_key && !has_key;
    const words = [name, off ? "needs a key" : note].filter(Boolean).join(": ");
    return { value: name, words, off };
  });
}

function tasks(offer: Offer, scene: string): Choice[] {
  const own = offer.tasks.filter((task) => !task.scenes.length || task.scenes.includes(scene));
  return [
    { value: "", words: "None: I talk to her freely" },
    ...own.map(({ id, instruction }) => ({ value: id, words: `${id}: ${instruction}` })),
  ];
}

/** Ask what to start, and go there; a scene may be chosen beforehand. */
export async function openStart(chosen = ""): Promise<void> {
  const problem = problemLine();
  const waiting = el("p", { class: "lead" }, "One moment");
  const made = dialog("A person in a room", "Talk to her, watch her think, and see what she does.", waiting, problem);
  try {
    const offer = await getOffer();
    waiting.replaceWith(form(offer, problem, chosen));
    made.querySelector("select")?.focus();
  } catch (error) {
    waiting.remove();
    tellProblem(problem, error);
  }
}

function form(offer: Offer, problem: HTMLElement, chosen: string): HTMLElement {
  const scenes = offer.scenes.map(({ name, title }) => ({ value: name, words: title }));
  const [sceneField, scene] = choose("Room", "start-scene", scenes);
  if (scenes.some(({ value }) => value === chosen)) scene.value = chosen;
  const [figureField, figure] = choose("Person", "start-figure", offer.figures.map((value) => ({ value, words: value.charAt(0).toUpperCase() + value.slice(1) })));
  const [modelField, model] = choose("Mind", "start-model", models(offer), true);
  const [taskField, task] = choose("Task", "start-task", tasks(offer, scene.value), true);
  const [profileField, profile] = choose("Spoken to", "start-profile", plain(offer.profiles));
  const labelings = offer.labelings.map((value) => ({ value, words: LABELINGS[value] ?? value }));
  const [labelingField, labeling] = choose("Tags", "start-labeling", labelings);
  const name = el("input", { type: "text", id: "start-name", attr: { placeholder: "as its provider calls it", maxlength: "100" } });
  const nameField = el("div", { class: "field wide" }, el("label", { for: "start-name" }, "Name of the model"), name);
  const askName = (): void => {
    nameField.hidden = !model.value.endsWith(ANY);
  };
  model.addEventListener("change", askName);
  askName();
  const approve = el("input", { type: "checkbox", id: "start-approve" });
  const tick = el("div", { class: "tick" }, approve, el("label", { for: "start-approve" }, "Ask me before every action"));
  const start = el("button", { class: "button main", type: "submit" }, "Open the room");
  const change = el("button", { class: "button", type: "button" }, "Edit a scene");
  change.addEventListener("click", () => {
    change.closest("dialog")?.close(); // Also if the address stays as it is.
    location.hash = `edit=${encodeURIComponent(scene.value)}`;
  });
  const grid = el("div", { class: "grid" }, sceneField, figureField, modelField, nameField, taskField, profileField, labelingField);
  const made = el("form", { class: "sheet-form" }, grid, tick, el("footer", {}, change, start));
  scene.addEventListener("change", () => setChoices(task, tasks(offer, scene.value)));
  made.addEventListener("submit", (event) => {
    event.preventDefault();
    start.disabled = true;
    problem.hidden = true;
    const wish = {
      scene: scene.value,
      model: model.value.endsWith(ANY) ? model.value.slice(0, -ANY.length) + name.value.trim() : model.value,
      profile: profile.value,
      labeling: labeling.value,
      figure: figure.value,
      task: task.value || null,
      variation: 0,
      approve: approve.checked,
    };
    openRoom(wish)
      .then((room) => {
        location.hash = `room=${encodeURIComponent(room)}`;
      })
      .catch((error: unknown) => {
        start.disabled = false;
        tellProblem(problem, error);
      });
  });
  return made;
}
