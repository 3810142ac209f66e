// Two runs side by side on one time line.

import { el, write } from "../dom.ts";
import { buildTurns } from "../mind/turns.ts";
import { text } from "../reading.ts";
import { listenToKeys } from "../shell/keys.ts";
import { type Shell, setBadge } from "../shell/shell.ts";
import { buildTimeline } from "../shell/timeline.ts";
import type { Show } from "../show.ts";
import { Seeing } from "./seeing.ts";

export function compare(shell: Shell, shows: readonly [Show, Show]): { close: () => void } {
  // The longer one has the clock; the other one stands still at its end.
  const [first, second] = shows;
  const clock = first.track.end >= second.track.end ? first : second;
  const other = clock === first ? second : first;
  other.player.playing = false;
  const timeline = buildTimeline(clock);
  const sides = shows.map((show) => {
    const turns = buildTurns(show);
    const seeing = new Seeing(show, () => {
      if (show === clock) timeline.update();
      else show.player.time = Math.min(show.track.end, clock.player.time);
      turns.update();
    });
    const { settings, run } = show.hello;
    const title = el("h2", {}, [text(settings.model), run].filter(Boolean).join(" · "));
    return { seeing, root: el("article", { class: "side" }, title, seeing.root, el("div", { class: "card" }, turns.root)) };
  });
  const desk = el("section", { class: "desk card", attr: { "aria-label": "Time" } }, timeline.root);
  shell.work.className = "work comparing";
  shell.work.replaceChildren(el("div", { class: "pair" }, ...sides.map((side) => side.root)), desk);
  write(shell.where, text(clock.hello.settings.instruction) || clock.hello.scene.title);
  setBadge(shell.badge, "Two runs", "");
  for (const { seeing } of sides) {
    seeing.open().catch((error: unknown) => seeing.failed(error instanceof Error ? error.message : String(error)));
  }
  const deaf = sides[0] ? listenToKeys(clock, sides[0].seeing, null) : () => undefined;
  return {
    close: () => {
      deaf();
      for (const { seeing } of sides) seeing.stage?.close();
    },
  };
}
