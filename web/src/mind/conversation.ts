// What was said, seen, thought and done, read from the events of a track.

import type { Call, EventMessage, RunEvent, SceneShape } from "../protocol.ts";
import { happeningWords } from "./words.ts";

export type Observed = Extract<RunEvent, { type: "observed" }>;

/** A picture with what is marked in it. */
export interface Seen {
  t: number;
  frame: string;
  view: Observed;
}

export type Outcome = "done" | "corrected" | "refused" | "left_out" | "waiting";

export interface Deed {
  call: Call;
  outcome: Outcome;
  code: string;
  text: string;
  t: number;
}

/** One turn: what she saw, what she thought of it, what she did. */
export interface TurnItem {
  kind: "turn";
  t: number;
  step: number;
  seen: Seen | null;
  closeUps: string[];
  note: string;
  unreadable: string;
  deeds: Deed[];
  tokens: [number, number];
  usd: number | null;
  seconds: number;
  messages: number;
  /** What she was told of the room and of herself. */
  state: string;
}

export interface SaidItem {
  kind: "said" | "answer" | "question" | "note";
  t: number;
  text: string;
  /** How it ended, for an answer. */
  reason: string;
}

export type Item = TurnItem | SaidItem;

const REASONS: Record<string, string> = {
  answered: "",
  stopped: "Stopped by you",
  step_limit: "Step limit reached",
  time_limit: "Time limit reached",
  empty_reply: "Said nothing",
  repeated: "Kept repeating itself",
  broken: "The episode broke",
};

/** How an episode ended, in words; empty if it was answered. */
export const reasonWords = (reason: string): string =>
  REASONS[reason] ?? reason.replaceAll("_", " ");

/** A reply that asks the user something back. */
export const isQuestion = (answer: string): boolean => /\?\s*$/.test(answer.trim());

export class Conversation {
  readonly items: Item[] = [];
  readonly views: Seen[] = [];
  /** Changes with every change. */
  version = 0;

  constructor(private readonly scene: SceneShape) {}

  add({ event, t, frame }: EventMessage): void {
    this.version++;
    switch (event.type) {
      case "started":
        this.say("said", t, event.instruction);
        break;
      case "observed":
        this.views.push({ t, frame, view: event });
        break;
      case "thought":
        this.think(event, t);
        break;
      case "acted":
        this.settle(event.call_id, { outcome: event.outcome as Outcome, code: event.code, text: event.text, t }, event);
        break;
      case "left_out":
        this.settle(event.call_id, { outcome: "left_out", code: "", text: event.why, t }, { ...event, arguments: {} });
        break;
      case "shown":
        this.turn?.closeUps.push(frame);
        break;
      case "happened":
        this.say("note", t, happeningWords(event, this.scene));
        break;
      case "vetoed":
        this.say("note", t, ["You objected", event.why].filter(Boolean).join(": "));
        break;
      case "lost":
        this.say("note", t, "An answer never came, and was asked for again");
        break;
      case "restored":
        this.say("note", t, "Everything is back as it was before the last instruction");
        break;
      case "ended":
        this.end(event, t);
        break;
      case "other":
        break;
    }
  }

  private get turn(): TurnItem | undefined {
    return this.items.findLast((item) => item.kind === "turn");
  }

  private say(kind: SaidItem["kind"], t: number, text: string, reason = ""): void {
    this.items.push({ kind, t, text, reason });
  }

  private think(event: Extract<RunEvent, { type: "thought" }>, t: number): void {
    this.items.push({
      kind: "turn",
      t,
      step: event.step,
      seen: this.views.at(-1) ?? null,
      closeUps: [],
      note: event.note,
      unreadable: event.unreadable,
      deeds: event.calls.map((call) => ({ call, outcome: "waiting", code: "", text: "", t })),
      tokens: event.tokens,
      usd: event.usd,
      seconds: event.seconds,
      messages: event.messages,
      state: event.state_text,
    });
  }

  private settle(
    id: string,
    how: Omit<Deed, "call">,
    event: { name: string; arguments: Record<string, unknown> },
  ): void {
    const turn = this.turn;
    if (!turn) return;
    const deed = turn.deeds.find((item) => item.call.id === id && item.outcome === "waiting");
    if (deed) Object.assign(deed, how);
    else {
      const call: Call = { id, name: event.name, arguments: event.arguments, note: "", confidence: null };
      turn.deeds.push({ call, ...how });
    }
  }

  private end(event: Extract<RunEvent, { type: "ended" }>, t: number): void {
    const reason = reasonWords(event.reason);
    if (event.answer.trim()) {
      this.say(isQuestion(event.answer) ? "question" : "answer", t, event.answer, reason);
    } else this.say("note", t, [reason, event.why].filter(Boolean).join(": ") || "Ended");
    const turn = this.turn;
    // A turn that only answers says so again as the answer.
    if (turn && !turn.deeds.length && turn.note.trim() === event.answer.trim()) turn.note = "";
  }
}
