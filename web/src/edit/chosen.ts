// What is selected, in numbers.

import { el, fill, write } from "../dom.ts";
import { choiceField, type Field, numberField, shareField, textField } from "./controls.ts";
import { type Draft, placeOf } from "./draft.ts";
import { type Catalog, keyOf, nameOf, type Ref, type SceneLight, type Two } from "./scene.ts";
import { levels } from "./support.ts";

const TURN_DEG = 15;

function placeFields(draft: Draft, ref: Ref): Field[] {
  const at = (): Two => placeOf(draft.data, ref) ?? [0, 0];
  const key = `place ${keyOf(ref)}`;
  return [
    numberField(draft, "x (m)", 0.05, () => at()[0], (x) => draft.place(ref, [x, at()[1]], "", `${key} x`)),
    numberField(draft, "y (m)", 0.05, () => at()[1], (y) => draft.place(ref, [at()[0], y], "", `${key} y`)),
  ];
}

function turnField(draft: Draft, ref: Ref): Field {
  const now = (): number => {
    if (ref.kind === "agent") return draft.data.agent.heading_deg;
    return ref.kind === "objects" || ref.kind === "furniture" ? (draft.data[ref.kind][ref.index]?.yaw_deg ?? 0) : 0;
  };
  return numberField(draft, "Turned (degrees)", TURN_DEG, now, (value) => draft.turn(ref, value - now(), `turn ${keyOf(ref)}`));
}

function areaFields(draft: Draft, index: number): Field[] {
  const words = (label: string, name: "name" | "kind"): Field =>
    textField(draft, label, 60, () => draft.data.areas[index]?.[name] ?? "", (value) =>
      draft.edit(({ areas: { [index]: area } }) => area && Object.assign(area, { [name]: value }), `area ${index} ${name}`),
    );
  const edge = (label: string, side: "min" | "max", axis: 0 | 1): Field =>
    numberField(draft, label, 0.05, () => draft.data.areas[index]?.[side][axis] ?? 0, (value) =>
      draft.edit(({ areas: { [index]: area } }) => {
        if (area) area[side][axis] = value;
      }, `area ${index} ${side} ${axis}`),
    );
  const edges = [edge("x from (m)", "min", 0), edge("x to (m)", "max", 0), edge("y from (m)", "min", 1), edge("y to (m)", "max", 1)];
  return [words("Name", "name"), words("Kind", "kind"), ...edges];
}

export function lightField(draft: Draft, index: number, label = `Light ${index + 1}`): Field {
  return shareField(draft, label, () => draft.data.lights[index]?.diffuse ?? 0, (value) =>
    draft.edit(({ lights: { [index]: light } }) => light && Object.assign(light, { diffuse: value }), `light ${index}`),
  );
}

function lightFields(draft: Draft, ref: Ref): Field[] {
  const light = (): SceneLight | undefined => draft.data.lights[ref.index];
  const number = (label: string, end: "position" | "target", axis: 0 | 1 | 2): Field =>
    numberField(draft, label, 0.05, () => light()?.[end][axis] ?? 0, (value) =>
      draft.edit(({ lights: { [ref.index]: changed } }) => {
        if (changed) changed[end][axis] = value;
      }, `light ${ref.index} ${end} ${axis}`),
    );
  const shadow = choiceField(
    draft,
    "Casts shadows",
    () => ["no", "yes"],
    () => (light()?.shadow ? "yes" : "no"),
    // More than one that does would draw the scene again for each.
    (value) => draft.edit(({ lights }) => lights.forEach((each, index) => (each.shadow = index === ref.index ? value === "yes" : each.shadow && value === "no"))),
  );
  const to = [number("Shines at x (m)", "target", 0), number("Shines at y (m)", "target", 1), number("Shines at height (m)", "target", 2)];
  return [lightField(draft, ref.index, "Brightness"), shadow, ...placeFields(draft, ref), number("Height (m)", "position", 2), ...to];
}

export function ambientField(draft: Draft): Field {
  return shareField(draft, "From everywhere", () => draft.data.ambient, (value) =>
    draft.edit((data) => {
      data.ambient = value;
    }, "ambient"),
  );
}

function fieldsOf(draft: Draft, catalog: Catalog, ref: Ref): Field[] {
  const { kind, index } = ref;
  if (kind === "areas") return areaFields(draft, index);
  if (kind === "lights") return lightFields(draft, ref);
  if (kind === "agent") return [...placeFields(draft, ref), turnField(draft, ref)];
  if (kind === "furniture") {
    const name = textField(draft, "Name", 60, () => draft.data.furniture[index]?.name ?? "", (value) => draft.rename(index, value));
    return [name, turnField(draft, ref), ...placeFields(draft, ref)];
  }
  const on = choiceField(
    draft,
    "On",
    () => levels(draft.data, catalog).map(({ support }) => support),
    () => draft.data.objects[index]?.on ?? "",
    (value) => draft.place(ref, placeOf(draft.data, ref) ?? [0, 0], value),
  );
  return [on, turnField(draft, ref), ...placeFields(draft, ref)];
}

function buttons(draft: Draft, ref: Ref): HTMLElement {
  const button = (words: string, act: () => void, more = ""): HTMLElement =>
    el("button", { class: `button small ${more}`, type: "button", on: { click: act } }, words);
  const turns = ["furniture", "objects", "agent"].includes(ref.kind);
  return el(
    "div",
    { class: "row" },
    turns && button("Turn left", () => draft.turn(ref, TURN_DEG)),
    turns && button("Turn right", () => draft.turn(ref, -TURN_DEG)),
    ref.kind !== "agent" && !isLastLight(draft, ref) && button("Remove", () => draft.remove(ref), "danger"),
  );
}

const isLastLight = ({ data }: Draft, { kind }: Ref): boolean => kind === "lights" && data.lights.length === 1;

/** For those who do not see it move. */
function whereWords({ data }: Draft, ref: Ref): string {
  const at = placeOf(data, ref);
  const on = ref.kind === "objects" ? ` on ${data.objects[ref.index]?.on ?? ""}` : "";
  return at ? `${nameOf(data, ref)}${on}, x ${at[0]}, y ${at[1]}` : "";
}

/** A section that follows what is selected. */
export function buildChosen(draft: Draft, catalog: Catalog): HTMLElement {
  const heading = el("h2");
  const body = el("div", { class: "fields" });
  const below = el("div");
  const told = el("p", { class: "unseen", role: "status" });
  const root = el("section", { attr: { "aria-label": "Selected" } }, heading, told, body, below);
  let shown = "";
  let made: Field[] = [];
  const update = (): void => {
    const { selected, data } = draft;
    // Whether a light may be removed depends on the others.
    const key = selected ? `${keyOf(selected)} ${data.lights.length}` : "none";
    heading.textContent = (selected && nameOf(data, selected)) || "Nothing selected";
    if (key !== shown) {
      shown = key;
      made = selected ? fieldsOf(draft, catalog, selected) : [];
      const help = "Click something in the room or in the list below. Drag moves it, R turns it, arrows nudge it, Delete removes it.";
      fill(body, ...(selected ? made.map(({ root: field }) => field) : [el("p", { class: "quiet" }, help)]));
      fill(below, selected && buttons(draft, selected));
    }
    for (const field of made) field.update();
    write(told, selected ? whereWords(draft, selected) : "");
  };
  draft.changes.listen(update);
  update();
  return root;
}
