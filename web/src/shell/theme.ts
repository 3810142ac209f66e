// Light and dark: as the system has it, until somebody chooses.

import { el, fill, icon, ICONS } from "../dom.ts";

const KEY = "adamo-theme";

function kept(): string | null {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null;
  }
}

function keep(theme: string): void {
  try {
    localStorage.setItem(KEY, theme);
  } catch {
    // It holds for this visit then.
  }
}

const dark = matchMedia("(prefers-color-scheme: dark)");
const system = (): string => (dark.matches ? "dark" : "light");

export function themeButton(): HTMLButtonElement {
  const button = el("button", { class: "button plain small square", type: "button" });
  const show = (theme: string): void => {
    document.documentElement.dataset.theme = theme;
    const other = theme === "dark" ? "light" : "dark";
    button.setAttribute("aria-label", `Switch to ${other} colours`);
    button.title = `Switch to ${other} colours`;
    fill(button, icon(theme === "dark" ? ICONS.sun : ICONS.moon));
  };
  show(kept() ?? system());
  dark.addEventListener("change", () => {
    if (!kept()) show(system());
  });
  button.addEventListener("click", () => {
    const next = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    keep(next);
    show(next);
  });
  return button;
}
