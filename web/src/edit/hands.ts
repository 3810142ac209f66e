// Pointer and keyboard of the editor: select, move, turn, nudge, remove.

import { steer } from "../view/pointer.ts";
import { type Corner, cornerAt, type Draft, placeOf } from "./draft.ts";
import { along } from "./orbit.ts";
import type { Picture } from "./picture.ts";
import { type Catalog, isSame, type Ref, type Two } from "./scene.ts";
import { levelAt } from "./support.ts";

const TURN_DEG = 15;
const NUDGE_M = 0.05;
/** A surface whose outward direction points up at least this much carries things. */
const LEVEL = 0.8;
const CLICK_PX = 5;
/** A corner of the selected area is taken within this distance. */
const NEAR_CORNER_M = 0.16;
/** What carries nothing. */
const LOOKED_THROUGH: readonly Ref["kind"][] = ["areas", "agent", "objects", "lights"];

interface Grip {
  ref: Ref;
  /** From the pointer on its plane to the thing's place. */
  offset: Two;
  height: number;
  from: { x: number; y: number };
  moved: boolean;
  /** Of an area, if that is held. */
  corner: Corner | null;
}

/** Let the pointer work on the picture. */
export function takeHold(canvas: HTMLCanvasElement, picture: Picture, draft: Draft, catalog: Catalog): void {
  let grip: Grip | null = null;

  const grab = (event: PointerEvent): boolean => {
    if (event.shiftKey) return false;
    const { selected, data } = draft;
    const floor = picture.atHeight(event, 0);
    const corner = floor && cornerAt(data, selected, [floor.x, floor.y], NEAR_CORNER_M);
    if (selected && corner) {
      grip = { ref: selected, offset: [0, 0], height: 0, from: { x: event.clientX, y: event.clientY }, moved: false, corner };
      return true;
    }
    const hit = picture.at(event);
    // An area covers much of the floor: the camera is turned over it until it is selected.
    if (!hit?.ref || (hit.ref.kind === "areas" && !isSame(hit.ref, draft.selected))) return false;
    const place = placeOf(draft.data, hit.ref);
    if (!place) return false;
    const offset: Two = [place[0] - hit.point.x, place[1] - hit.point.y];
    grip = { ref: hit.ref, offset, height: hit.point.z, from: { x: event.clientX, y: event.clientY }, moved: false, corner: null };
    draft.select(hit.ref);
    return true;
  };

  const drag = (event: PointerEvent): void => {
    if (!grip) return;
    if (Math.hypot(event.clientX - grip.from.x, event.clientY - grip.from.y) > CLICK_PX) grip.moved = true;
    if (!grip.moved) return;
    const { ref, offset, height } = grip;
    const key = `drag ${ref.kind} ${ref.index}`;
    if (ref.kind !== "objects") {
      const point = picture.atHeight(event, height);
      if (point && grip.corner) draft.reshape(ref.index, grip.corner, inside(draft, [point.x, point.y]), key);
      else if (point) draft.place(ref, inside(draft, [point.x + offset[0], point.y + offset[1]]), "", key);
      return;
    }
    const hit = picture.at(event, (other) => isSame(other, ref) || LOOKED_THROUGH.includes(other.kind));
    const level = hit && hit.normal.z > LEVEL ? levelAt(draft.data, catalog, [hit.point.x, hit.point.y, hit.point.z]) : null;
    if (hit && level) draft.place(ref, [hit.point.x, hit.point.y], level.support, key);
  };

  steer(canvas, picture.orbit, {
    down: grab,
    move: drag,
    up: () => {
      draft.settle();
      grip = null;
    },
    click: (event) => draft.select(picture.at(event)?.ref ?? null),
    hover: () => undefined,
    steered: () => picture.touch(),
  });
}

/** Nothing is dragged out of the room. */
function inside(draft: Draft, [x, y]: Two): Two {
  const { x_min, x_max, y_min, y_max } = draft.data.room;
  return [Math.min(x_max, Math.max(x_min, x)), Math.min(y_max, Math.max(y_min, y))];
}

const TYPED = "input:not([type=range], [type=checkbox]), textarea, select";
const OWN_ARROWS = "input, select, textarea, summary, [role=tab]";

/** What a key does; false if nothing. */
export function pressed(event: KeyboardEvent, draft: Draft, heading: number): boolean {
  const { key } = event;
  const typing = event.target instanceof Element && event.target.matches(TYPED);
  if ((event.ctrlKey || event.metaKey) && !event.altKey) {
    if (typing) return false; // The field has its own.
    if (key.toLowerCase() === "z") event.shiftKey ? draft.redo() : draft.undo();
    else if (key.toLowerCase() === "y") draft.redo();
    else return false;
    return true;
  }
  const { selected } = draft;
  if (typing || event.altKey || !selected) return false;
  if (key === "r" || key === "R") draft.turn(selected, event.shiftKey ? -TURN_DEG : TURN_DEG);
  else if (key === "Delete" || key === "Backspace") draft.remove(selected);
  else if (key === "Escape") draft.select(null);
  else if (key.startsWith("Arrow") && !(event.target instanceof Element && event.target.matches(OWN_ARROWS))) {
    const place = placeOf(draft.data, selected);
    const [dx, dy] = along(heading, key);
    if (!place) return false;
    draft.place(selected, [place[0] + dx * NUDGE_M, place[1] + dy * NUDGE_M]);
  } else return false;
  return true;
}

/** Listen. Returns how to end it. */
export function listenToEditKeys(draft: Draft, picture: Picture): () => void {
  const listener = (event: KeyboardEvent): void => {
    if (document.querySelector("dialog[open]")) return;
    if (pressed(event, draft, picture.orbit.heading)) event.preventDefault();
  };
  document.addEventListener("keydown", listener);
  return () => document.removeEventListener("keydown", listener);
}
