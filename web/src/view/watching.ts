// Puts room, desk and mind of one track on the page.

import type { FrameView } from "../mind/frame.ts";
import { buildMind } from "../mind/panel.ts";
import { type Shell, setBadge, tabs } from "../shell/shell.ts";
import { buildTimeline } from "../shell/timeline.ts";
import type { Show } from "../show.ts";
import { buildDesk } from "../talk/desk.ts";
import { buildSpeech } from "../talk/speech.ts";
import { text } from "../reading.ts";
import { el, write } from "../dom.ts";
import { buildApproval } from "../take/approve.ts";
import { Drag } from "../take/drag.ts";
import { Human } from "../take/human.ts";
import { Seeing } from "./seeing.ts";
import { listenToKeys } from "../shell/keys.ts";

export interface Watching {
  show: Show;
  seeing: Seeing;
  close: () => void;
}

export function watch(shell: Shell, show: Show): Watching {
  const timeline = buildTimeline(show);
  const mind = buildMind(show);
  const speech = show.may("say") ? buildSpeech(show, () => seeing.stage?.figure.face ?? null) : null;
  const desk = buildDesk(show, timeline.root, speech?.buttons ?? null);
  const seeing = new Seeing(show, () => {
    timeline.update();
    mind.update();
    if (!show.player.following) desk.update();
  });
  const taking = takePart(show, seeing, mind.frame);
  const left = el("div", { class: "left" }, seeing.root, desk.root);
  desk.root.prepend(...taking);
  desk.root.append(seeing.roomLayers());
  shell.work.className = "work";
  shell.work.replaceChildren(left, tabs(shell.work), mind.root);
  write(shell.where, whereWords(show));
  const badge = (): void => {
    const isLive = show.hello.live;
    setBadge(shell.badge, isLive ? (show.connected ? "Live" : "Connecting") : "Replay", isLive ? "live" : "");
    const { notice } = show;
    seeing.tell(notice?.text ?? "", notice?.level === "error");
    if (!notice) return;
    setTimeout(() => {
      if (show.notice !== notice) return;
      show.notice = null;
      seeing.tell("");
    }, 6000);
  };
  show.changes.listen(badge);
  badge();
  seeing.open().catch((error: unknown) => {
    seeing.failed(`The room cannot be shown: ${error instanceof Error ? error.message : String(error)}`);
  });
  // For measuring and for tests: ?debug lets the console reach what is shown.
  if (new URLSearchParams(location.search).has("debug")) Object.assign(globalThis, { studio: { show, seeing } });
  const deaf = listenToKeys(show, seeing, desk.talkBox);
  return {
    show,
    seeing,
    close: () => {
      deaf();
      speech?.close();
      show.live?.close();
      seeing.stage?.close();
    },
  };
}

/** What a person may do in a live room beyond talking. */
function takePart(show: Show, seeing: Seeing, frame: FrameView): HTMLElement[] {
  const drag = new Drag(show, seeing);
  const human = show.may("act") ? new Human(show) : null;
  human?.listenTo(frame);
  seeing.hands = {
    grab: (hit) => !human?.isTurn && drag.grab(hit),
    drag: (event) => drag.drag(event),
    release: () => drag.release(),
    click: (hit) => human?.click(hit),
    aims: () => human?.isTurn ?? false,
  };
  const asks = show.may("approval") && !human;
  return [...(asks ? [buildApproval(show)] : []), ...(human ? [human.root] : [])];
}

function whereWords({ hello }: Show): string {
  const { settings, scene } = hello;
  const model = text(settings.model);
  return [scene.title || scene.name, model, text(settings.profile)].filter(Boolean).join(" · ");
}
