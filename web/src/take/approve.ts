// Take part: let her do what she is about to do, or object and say why.

import { el, fill, icon, ICONS } from "../dom.ts";
import { callCode, callWords } from "../mind/words.ts";
import { text } from "../reading.ts";
import type { Show } from "../show.ts";

export function buildApproval(show: Show): HTMLElement {
  const what = el("div");
  const yes = el("button", { class: "button main", type: "button" }, icon(ICONS.check), "Approve");
  const why = el("input", { type: "text", id: "veto-why", attr: { placeholder: "Why not?", maxlength: "1000" } });
  const no = el("button", { class: "button danger", type: "submit" }, "Object");
  const label = el("label", { class: "unseen", for: "veto-why" }, "Why you object");
  const form = el("form", { class: "row" }, yes, label, why, no);
  const root = el("section", { class: "ask talk-part", role: "alertdialog", attr: { "aria-label": "She asks before she acts", hidden: "" } }, el("h2", {}, "May I?"), what, form);
  let shown = -1;
  yes.addEventListener("click", () => show.say({ type: "approve" }));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (show.say({ type: "veto", why: why.value.trim() })) why.value = "";
  });
  const update = (): void => {
    const { open } = show;
    root.hidden = !open;
    if (!open || open.n === shown) return;
    shown = open.n;
    const { scene } = show.hello;
    const calls = open.calls.map((call) =>
      el("div", { class: "deed" }, el("strong", {}, callWords(call.name, call.arguments, scene)), el("code", {}, callCode(call.name, call.arguments))),
    );
    fill(what, ...(calls.length ? calls : [el("p", {}, open.note || "Answer")]));
    show.point(text(open.calls[0]?.arguments.object));
    yes.focus();
  };
  show.changes.listen(update);
  update();
  return root;
}

/** Whether she asks before every action. */
export function approvalTick(show: Show): HTMLElement {
  const box = el("input", { type: "checkbox", id: "approval-on" });
  box.checked = show.hello.settings.approve === true;
  box.addEventListener("change", () => {
    if (!show.say({ type: "approval", on: box.checked })) box.checked = !box.checked;
  });
  show.changes.listen(() => {
    if (show.open) box.checked = true;
  });
  return el("div", { class: "tick talk-part" }, box, el("label", { for: "approval-on" }, "She asks me before every action"));
}
