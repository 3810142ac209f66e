// The runs that can be replayed: one, or two side by side.

import { el } from "../dom.ts";
import type { RunOffer } from "../protocol.ts";
import { getOffer } from "../server.ts";
import { dialog, problemLine, tellProblem } from "./start.ts";

export async function openRuns(): Promise<void> {
  const problem = problemLine();
  const waiting = el("p", { class: "lead" }, "One moment");
  const made = dialog("Runs", "Replay one, or choose two to see them side by side.", waiting, problem);
  try {
    const { runs } = await getOffer();
    waiting.replaceWith(runs.length ? runList(runs) : el("p", {}, "There are no runs yet. Start the studio with run folders to replay them."));
    made.querySelector("button")?.focus();
  } catch (error) {
    waiting.remove();
    tellProblem(problem, error);
  }
}

function runList(runs: readonly RunOffer[]): HTMLElement {
  const chosen = new Set<string>();
  const compare = el("button", { class: "button", type: "button" }, "Compare two");
  compare.disabled = true;
  compare.addEventListener("click", () => {
    location.hash = `compare=${[...chosen].map(encodeURIComponent).join(",")}`;
  });
  const rows = runs.map((run, i) => {
    const box = el("input", { type: "checkbox", id: `run-${i}`, attr: { "aria-label": `Choose ${run.name}` } });
    box.addEventListener("change", () => {
      if (box.checked) chosen.add(run.name);
      else chosen.delete(run.name);
      compare.disabled = chosen.size !== 2;
    });
    const open = el("button", { class: "button small main", type: "button", attr: { "aria-label": `Replay ${run.name}` } }, "Replay");
    open.addEventListener("click", () => {
      location.hash = `run=${encodeURIComponent(run.name)}`;
    });
    const facts = [run.model, scoreWords(run.completion), run.when, run.name].filter(Boolean).join(" · ");
    const what = el("div", {}, el("p", { title: run.instruction }, run.instruction || run.name), el("small", {}, facts));
    return el("li", { class: "tick-row" }, box, what, open);
  });
  return el("div", { class: "sheet-form" }, el("ul", { class: "runs" }, ...rows), el("footer", {}, compare));
}

/** A score that is not known is not shown as zero. */
const scoreWords = (completion: number | null): string =>
  completion === null ? "not scored" : `${Math.round(completion * 100)} % done`;
