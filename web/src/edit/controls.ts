// Fields that show a value of the scene and change it.

import { el } from "../dom.ts";
import type { Draft } from "./draft.ts";

export interface Field {
  root: HTMLElement;
  /** Show the value as it is now, unless somebody is typing. */
  update: () => void;
}

let count = 0;

function field(label: string, input: HTMLInputElement | HTMLSelectElement, get: () => string, draft: Draft): Field {
  input.id ||= `edit-${++count}`;
  input.addEventListener("change", () => draft.settle());
  const update = (): void => {
    const isTyping = document.activeElement === input && input.matches("[type=text], [type=number]");
    if (!isTyping && input.value !== get()) input.value = get();
  };
  // What was typed and is no value goes when one leaves.
  input.addEventListener("blur", () => {
    input.value = get();
  });
  input.value = get();
  return { root: el("div", { class: "field" }, el("label", { for: input.id }, label), input), update };
}

export function numberField(draft: Draft, label: string, step: number, get: () => number, set: (value: number) => void): Field {
  const input = el("input", { type: "number", attr: { step: String(step), inputmode: "decimal" } });
  input.addEventListener("input", () => {
    const value = input.valueAsNumber;
    if (Number.isFinite(value)) set(value);
  });
  return field(label, input, () => String(get()), draft);
}

export function textField(draft: Draft, label: string, most: number, get: () => string, set: (value: string) => void): Field {
  const input = el("input", { type: "text", attr: { maxlength: String(most), autocomplete: "off" } });
  input.addEventListener("input", () => set(input.value));
  return field(label, input, get, draft);
}

export function choiceField(draft: Draft, label: string, choices: () => string[], get: () => string, set: (value: string) => void): Field {
  const input = el("select");
  const fillIn = (): void => {
    const names = [...new Set([...choices(), get()])];
    if ([...input.options].map(({ value }) => value).join() === names.join()) return;
    input.replaceChildren(...names.map((value) => el("option", { attr: { value } }, value.replace("/", ": "))));
    input.value = get();
  };
  fillIn();
  input.addEventListener("change", () => set(input.value));
  const made = field(label, input, get, draft);
  return {
    root: made.root,
    update: () => {
      fillIn();
      made.update();
    },
  };
}

export function shareField(draft: Draft, label: string, get: () => number, set: (value: number) => void): Field {
  const input = el("input", { type: "range", attr: { min: "0", max: "1", step: "0.01" } });
  input.addEventListener("input", () => set(input.valueAsNumber));
  return field(label, input, () => String(get()), draft);
}
