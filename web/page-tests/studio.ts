// What the tests of the page have in common: a page that is watched, a room, a place on the screen.

import { test as plain, expect, type Page } from "@playwright/test";

export { expect };

/** Requests that leave the machine, and errors: there are to be none. */
export const test = plain.extend<{ watched: string[] }>({
  watched: [
    async ({ page, baseURL }, use) => {
      const odd: string[] = [];
      const own = new URL(baseURL ?? "").origin;
      page.on("request", (request) => {
        const { protocol, origin } = new URL(request.url());
        if (!["blob:", "data:"].includes(protocol) && origin !== own) odd.push(request.url());
      });
      page.on("pageerror", (error) => odd.push(String(error)));
      page.on("dialog", (dialog) => {
        odd.push(`dialog: ${dialog.message()}`);
        void dialog.dismiss();
      });
      await use(odd);
      // A server keeps few rooms open at once.
      const room = new URLSearchParams(new URL(page.url()).hash.slice(1)).get("room");
      if (room) await page.request.delete(`api/rooms/${room}`);
      expect(odd).toEqual([]);
    },
    { auto: true },
  ],
});

/** Wait until the room is drawn. */
export async function drawn(page: Page): Promise<void> {
  await expect(page.locator(".stage canvas")).toBeVisible();
  await expect(page.locator(".stage .loading")).toHaveCount(0);
}

/** Open a live room from the start dialog. */
export async function openRoom(page: Page, model = "baseline", approve = false): Promise<void> {
  await page.goto("?debug");
  await page.getByLabel("Mind").selectOption(model);
  if (approve) await page.getByLabel("Ask me before every action").check();
  await page.getByRole("button", { name: "Open the room" }).click();
  await drawn(page);
  await expect(page.locator(".badge")).toHaveText("Live");
}

export async function say(page: Page, words: string): Promise<void> {
  await page.getByLabel("Tell her what to do").fill(words);
  await page.getByRole("button", { name: "Say" }).click();
}

interface Shown {
  studio: {
    seeing: {
      stage: {
        room: { things: Map<number, { position: { clone: () => Projected } }> };
        cameras: { camera: unknown };
        stats: Record<string, number>;
      };
    };
  };
}

interface Projected {
  x: number;
  y: number;
  z: number;
  project: (camera: unknown) => Projected;
}

/** Where a thing is on the screen. */
export async function placeOf(page: Page, id: number): Promise<{ x: number; y: number }> {
  const at = await page.evaluate((wanted) => {
    const { stage } = (globalThis as unknown as Shown).studio.seeing;
    const seen = stage.room.things.get(wanted)?.position.clone().project(stage.cameras.camera);
    return seen ? { x: seen.x, y: seen.y } : { x: 9, y: 9 };
  }, id);
  const area = await page.locator(".stage canvas").boundingBox();
  if (!area) throw new Error("There is no picture.");
  return { x: area.x + ((at.x + 1) / 2) * area.width, y: area.y + ((1 - at.y) / 2) * area.height };
}

export const stats = (page: Page): Promise<Record<string, number>> =>
  page.evaluate(() => (globalThis as unknown as Shown).studio.seeing.stage.stats);
