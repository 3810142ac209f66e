// From the address to what is shown.

import { el } from "../dom.ts";
import { edit, loadEdit } from "../edit/editing.ts";
import type { Hello } from "../protocol.ts";
import { getTrack, heldTrack, Live } from "../server.ts";
import { Show } from "../show.ts";
import { compare } from "../view/comparing.ts";
import { watch } from "../view/watching.ts";
import type { Shell } from "./shell.ts";
import { openRuns } from "./runs.ts";
import { openStart } from "./start.ts";

export class Router {
  private open: { close: () => void }[] = [];
  private turn = 0;

  constructor(private readonly shell: Shell) {
    shell.newButton.addEventListener("click", () => void openStart());
    shell.runsButton.addEventListener("click", () => void openRuns());
  }

  start(): void {
    const held = heldTrack();
    if (held) {
      // There is no server to ask for anything else.
      this.shell.newButton.hidden = this.shell.runsButton.hidden = true;
      this.open.push(watch(this.shell, new Show(held)));
      return;
    }
    addEventListener("hashchange", () => void this.go());
    void this.go();
  }

  private async go(): Promise<void> {
    const asked = new URLSearchParams(location.hash.slice(1));
    const turn = ++this.turn;
    for (const watching of this.open) watching.close();
    this.open = [];
    document.querySelectorAll("dialog[open]").forEach((dialog) => (dialog as HTMLDialogElement).close());
    const room = asked.get("room");
    const run = asked.get("run");
    const scene = asked.get("edit");
    const pair = (asked.get("compare") ?? "").split(",").filter(Boolean).map(decodeURIComponent);
    try {
      if (room) this.goLive(room, turn);
      else if (run) await this.goReplay(run, turn);
      else if (scene) await this.goEdit(scene, turn);
      else if (pair.length === 2) await this.goCompare(pair, turn);
      else {
        this.wait("");
        await openStart();
      }
    } catch (error) {
      if (turn === this.turn) this.wait(error instanceof Error ? error.message : String(error));
    }
  }

  /** Words in place of a room. */
  private wait(words: string): void {
    this.shell.work.className = "work waiting";
    this.shell.work.replaceChildren(el("p", { role: "status" }, words));
    this.shell.badge.hidden = true;
    this.shell.where.textContent = "";
  }

  private goLive(room: string, turn: number): void {
    this.wait("Connecting to the room");
    let show: Show | null = null;
    const begin = (hello: Hello): void => {
      if (show || turn !== this.turn) return;
      show = new Show(hello);
      show.live = live;
      show.connect(true);
      this.open.push(watch(this.shell, show));
    };
    const live = new Live(room, {
      message: (message) => {
        if (turn !== this.turn) live.close();
        else if (message.type === "hello") begin({ ...message, live: true });
        else show?.take(message);
      },
      connected: (on) => {
        if (show) show.connect(on);
        else if (!on && turn === this.turn) this.wait("This room cannot be reached. It may have been closed.");
      },
    });
  }

  private async goCompare(runs: readonly string[], turn: number): Promise<void> {
    this.wait("Preparing the replays");
    const [first, second] = await Promise.all(runs.map((run) => getTrack(run, () => undefined)));
    if (turn !== this.turn || !first || !second) return;
    this.open.push(compare(this.shell, [new Show(first), new Show(second)]));
  }

  private async goEdit(scene: string, turn: number): Promise<void> {
    this.wait("Opening the scene");
    const { data, catalog } = await loadEdit(scene);
    if (turn !== this.turn) return;
    this.open.push(edit(this.shell, scene, data, catalog));
  }

  private async goReplay(run: string, turn: number): Promise<void> {
    this.wait("Preparing the replay");
    const track = await getTrack(run, () => this.wait("The run is executed again for its replay"));
    if (turn !== this.turn) return;
    this.open.push(watch(this.shell, new Show(track)));
  }
}
