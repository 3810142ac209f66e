// A run as one HTML file, opened from the disk: it shows the room, and asks nobody for anything.

import { test } from "@playwright/test";
import { drawn, expect } from "./studio.ts";

/** A folder with the exported runs: an honest one, and one with markup in every text. */
const PAGES = process.env.STUDIO_EXPORTED ?? "";

for (const name of ["run", "evil"]) {
  test(`the exported page of ${name} needs no server`, async ({ page }) => {
    test.skip(!PAGES, "nothing is exported");
    const address = new URL(`file://${PAGES}/${name}.html`).href;
    const odd: string[] = [];
    page.on("request", (request) => {
      if (request.url().split("#")[0] !== address && !/^(data|blob):/.test(request.url())) odd.push(request.url());
    });
    page.on("pageerror", (error) => odd.push(String(error)));
    page.on("dialog", (dialog) => {
      odd.push(`dialog: ${dialog.message()}`);
      void dialog.dismiss();
    });
    await page.goto(address);
    await drawn(page);
    await expect(page.locator(".badge")).toHaveText("Replay");
    await expect(page.locator(".frame img")).toHaveJSProperty("complete", true);
    await page.getByText("Remembers").click();
    await expect(page.locator(".state-text")).toContainText("Symbolic state");
    await page.getByLabel("Time", { exact: true }).fill("1000");
    await expect(page.locator(".turn.future")).toHaveCount(0);
    await expect(page.getByRole("button", { name: "New room" })).toBeHidden();
    await expect(page.locator("#app img[src='x'], #app script, #app b b")).toHaveCount(0);
    expect(odd).toEqual([]);
  });
}
