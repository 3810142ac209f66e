// The keyboard: Space plays, arrows step, 1 to 3 choose the camera, Esc stops her, / goes to the talk box.

import type { Show } from "../show.ts";
import { CAMERAS, type Seeing } from "../view/seeing.ts";

const isTyping = (target: EventTarget | null): boolean =>
  target instanceof HTMLElement && target.matches("input:not([type=range]), textarea, select");

const keepsKey = (target: EventTarget | null, key: string): boolean =>
  target instanceof HTMLElement &&
  ((key === " " && target.matches("button, a, input")) || (key.startsWith("Arrow") && target.matches("input, [role=tab]")));

/** Listen. Returns how to end it. */
export function listenToKeys(show: Show, seeing: Seeing, talkBox: HTMLInputElement | null): () => void {
  const act = (key: string): boolean => {
    if (key === " ") show.player.toggle();
    else if (key === "ArrowRight") show.player.step(1);
    else if (key === "ArrowLeft") show.player.step(-1);
    else if (key === "s" || key === "S") seeing.toggleStats();
    else if (key === "/" && talkBox) talkBox.focus();
    else if (key >= "1" && key <= "3") seeing.chooseCamera(CAMERAS[Number(key) - 1]?.[0] ?? "free");
    else return false;
    return true;
  };
  const listener = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    if (event.key === "Escape" && show.may("stop")) {
      show.say({ type: "stop" });
      return;
    }
    if (isTyping(event.target) || keepsKey(event.target, event.key)) return;
    if (act(event.key)) event.preventDefault();
  };
  document.addEventListener("keydown", listener);
  return () => document.removeEventListener("keydown", listener);
}
