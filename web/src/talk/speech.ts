// The two buttons of speech beside the talk box: listen to me, and speak to me.

import { el, icon, ICONS } from "../dom.ts";
import { readAloud } from "../mind/words.ts";
import { getSpeech } from "../server.ts";
import type { Show } from "../show.ts";
import type { Face } from "../view/face.ts";
import { canListen, Microphone, Voice } from "./voice.ts";

const NO_MICROPHONE = "A microphone needs this page on localhost or over HTTPS";
/** What is said to stop her is done at once, and never taken for an instruction. */
const STOPS = /^(please )?(stop|halt|wait|stop it|stop please)[.!]?$/i;

export interface Speech {
  buttons: HTMLElement;
  close: () => void;
}

/** Buttons that stay away where the server neither hears nor speaks. */
export function buildSpeech(show: Show, face: () => Face | null): Speech {
  const listen = button(ICONS.mic, "Listen to me");
  const aloud = button(ICONS.speaker, "Speak to me");
  const buttons = el("span", { class: "speech", attr: { hidden: "" } }, listen, aloud);
  const voice = new Voice(face, (why) => show.tellUser(why, "error"));
  let microphone: Microphone | null = null;
  let told = show.story.items.length;

  const press = (which: HTMLButtonElement, on: boolean): void => which.setAttribute("aria-pressed", String(on));
  const heed = (what: Face["heeds"]): void => {
    const hers = face();
    if (hers) hers.heeds = what;
  };
  const deafen = (): void => {
    microphone?.close();
    microphone = null;
    heed(null);
    press(listen, false);
  };
  const done = (): void => {
    // He may have gone on to speak meanwhile.
    if (face()?.heeds === "thinking") heed(null);
  };
  const heard = (text: string): void => {
    done();
    if (!text) return;
    if (STOPS.test(text)) show.say({ type: "stop" });
    else if (show.say({ type: "say", text })) show.player.catchUp();
  };
  const hearken = async (): Promise<void> => {
    try {
      microphone = await Microphone.open({
        began: () => {
          voice.stop();
          heed("listening");
        },
        ended: () => heed("thinking"),
        heard,
        failed: (why) => {
          done();
          show.tellUser(why, "error");
        },
      });
      press(listen, true);
    } catch {
      show.tellUser("The browser gives no microphone. Allow it for this page, and try again.", "error");
    }
  };
  listen.addEventListener("click", () => (microphone ? deafen() : void hearken()));
  aloud.addEventListener("click", () => {
    const on = aloud.getAttribute("aria-pressed") !== "true";
    press(aloud, on);
    if (!on) voice.stop();
  });
  show.changes.listen(() => {
    const { items } = show.story;
    const fresh = items.slice(told);
    told = items.length;
    if (aloud.getAttribute("aria-pressed") !== "true" || !show.player.following) return;
    const tags = show.hello.scene.objects.map((object) => object.tag);
    for (const item of fresh) {
      if ((item.kind === "answer" || item.kind === "question") && item.text) voice.say(readAloud(item.text, tags));
    }
  });
  getSpeech().then(
    ({ hears, speaks }) => {
      buttons.hidden = !hears && !speaks;
      listen.hidden = !hears;
      aloud.hidden = !speaks;
      if (!canListen()) {
        listen.disabled = true;
        listen.title = NO_MICROPHONE;
      }
    },
    () => undefined,
  );
  return {
    buttons,
    close: () => {
      deafen();
      voice.stop();
    },
  };
}

function button(path: string, label: string): HTMLButtonElement {
  const attr = { "aria-label": label, "aria-pressed": "false" };
  return el("button", { class: "button", type: "button", title: label, attr }, icon(path));
}
