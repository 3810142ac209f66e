// Keeps edits against loss while the tab is open: a link, or "back", does not throw them away.

import type { Draft } from "./draft.ts";
import { readScene, type SceneData } from "./scene.ts";

export class Keeping {
  /** Whether edits of before are shown again. */
  readonly isBack: boolean;
  private readonly key: string;
  /** What need not be kept. */
  private safe: SceneData;

  constructor(
    scene: string,
    private readonly draft: Draft,
  ) {
    this.key = `adamo-edit ${scene}`;
    this.safe = draft.data;
    const kept = this.read();
    this.isBack = kept !== null;
    // As an edit, so that it can be undone.
    if (kept) draft.edit((now) => Object.assign(now, kept));
    draft.changes.listen(() => this.keep());
  }

  /** The scene is saved. */
  saved(data: SceneData): void {
    this.safe = data;
    this.keep();
  }

  private keep(): void {
    const { data } = this.draft;
    try {
      if (data === this.safe) sessionStorage.removeItem(this.key);
      else sessionStorage.setItem(this.key, JSON.stringify(data));
    } catch {
      // Then they last as long as the page.
    }
  }

  private read(): SceneData | null {
    try {
      const told = sessionStorage.getItem(this.key);
      return told ? readScene(JSON.parse(told)) : null;
    } catch {
      return null;
    }
  }
}
