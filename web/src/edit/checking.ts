// Has the scene checked by the server, a moment after the last edit.

import { Changes } from "../show.ts";
import type { Draft } from "./draft.ts";
import type { Finding, SceneData } from "./scene.ts";

export const CALM_MS = 400;

export type Check = (data: SceneData) => Promise<Finding[]>;

export class Checking {
  readonly changes = new Changes();
  findings: Finding[] = [];
  /** Why nothing is known; empty if it is. */
  problem = "";
  isBusy = false;
  private turn = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private seen: SceneData | null = null;

  constructor(
    private readonly draft: Draft,
    private readonly check: Check,
  ) {
    draft.changes.listen(() => this.later());
    this.later();
  }

  private later(): void {
    const { data } = this.draft;
    if (data === this.seen) return; // Something else is selected, no more.
    this.seen = data;
    clearTimeout(this.timer);
    const turn = ++this.turn;
    this.isBusy = true;
    this.changes.tell();
    this.timer = setTimeout(() => void this.ask(data, turn), CALM_MS);
  }

  private async ask(data: SceneData, turn: number): Promise<void> {
    let [found, problem]: [Finding[], string] = [[], ""];
    try {
      found = await this.check(data);
    } catch (error) {
      problem = error instanceof Error ? error.message : String(error);
    }
    if (turn !== this.turn) return; // An answer about an older scene.
    this.findings = found;
    this.problem = problem;
    this.isBusy = false;
    this.changes.tell();
  }

  close(): void {
    clearTimeout(this.timer);
    this.turn++;
  }
}
