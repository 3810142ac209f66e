// Calls in words that a visitor understands, and numbers as people write them.

import type { RunEvent, SceneShape } from "../protocol.ts";
import { number, text } from "../reading.ts";

/** "Tape_4" as "Tape 4"; an opaque tag stays as it is. */
export const spoken = (tag: string): string =>
  tag.replace(/([a-z])([A-Z])/g, "$1 $2").replaceAll("_", " ");

/** Text with the tags of objects as people say them. */
export function readAloud(text: string, tags: readonly string[]): string {
  const known = new Set(tags);
  return text.replace(/[A-Za-z]+_\d+/g, (part) => (known.has(part) ? spoken(part) : part));
}

const metres = (value: number): string => {
  const short = value.toFixed(2);
  return short === "-0.00" ? "0.00" : short;
};

const place = (args: Record<string, unknown>): [number, number, number] => [
  number(args.x),
  number(args.y),
  number(args.z),
];

/** The piece of furniture that a point is on or in; "floor" low down; empty in the air. */
export function whereIs([x, y, z]: readonly number[], scene: SceneShape): string {
  const at = [x ?? 0, y ?? 0, z ?? 0] as const;
  const found = scene.furniture
    .filter(({ center, size }) =>
      [0, 1].every((axis) => Math.abs((at[axis] ?? 0) - (center[axis] ?? 0)) <= (size[axis] ?? 0) / 2 + 0.06),
    )
    .filter(({ center, size }) => at[2] <= center[2] + size[2] / 2 + 0.4 && at[2] > 0.12 && size[2] > 0.1)
    .sort((a, b) => a.size[0] * a.size[1] - b.size[0] * b.size[1]);
  const first = found[0];
  if (first) return `the ${first.name}`;
  return at[2] <= 0.2 ? "the floor" : "";
}

/** What a call asks for, in words. */
export function callWords(name: string, args: Record<string, unknown>, scene: SceneShape): string {
  const thing = spoken(text(args.object));
  const [x, y, z] = place(args);
  switch (name) {
    case "Look": {
      const where = whereIs([x, y, z], scene);
      return where ? `Look at ${where}` : "Look there";
    }
    case "Walk":
      return "Walk there";
    case "Pick":
      return `Pick up ${thing}`;
    case "Drop": {
      const where = whereIs([x, y, z], scene);
      return `Put ${thing} down${where ? ` on ${where}` : ""}`;
    }
    case "Inspect":
      return `Look closely at ${thing}`;
    case "Survey":
      return "Look closely at everything in view";
    case "Finish":
      return "Finish";
    default:
      return name;
  }
}

/** What somebody did in the room, in words. */
export function happeningWords(event: Extract<RunEvent, { type: "happened" }>, { objects }: SceneShape): string {
  const who = event.by_user ? "You" : "Somebody";
  const tag = objects.find(({ id }) => id === event.object_id)?.tag;
  const thing = tag ? spoken(tag) : "something";
  switch (event.what) {
    case "object_moved":
      return `${who} moved ${thing}`;
    case "object_taken":
      return `${who} took ${thing} out of the room`;
    case "object_added":
      return `${who} brought ${thing} in`;
    case "light_changed":
      return `${who} changed a light`;
    default:
      return `Something happened: ${event.what.replaceAll("_", " ")}`;
  }
}

/** The call as the tool got it. */
export function callCode(name: string, args: Record<string, unknown>): string {
  const parts = Object.entries(args).map(([key, value]) =>
    typeof value === "number" ? metres(value) : typeof value === "string" ? value : `${key}=${JSON.stringify(value)}`,
  );
  return `${name}(${parts.join(", ")})`;
}

export function clock(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

export const count = (value: number): string => new Intl.NumberFormat("en").format(value);

/** Tokens and money; unknown money is not shown as zero. */
export function spentWords(tokens: readonly [number, number], usd: number | null): string {
  const total = tokens[0] + tokens[1];
  if (!total) return usd ? dollars(usd) : "No tokens used";
  const used = `${count(tokens[0])} tokens in, ${count(tokens[1])} out`;
  return usd === null ? used : `${used}, ${dollars(usd)}`;
}

const dollars = (usd: number): string => `$${usd.toFixed(usd < 0.1 ? 4 : 2)}`;
