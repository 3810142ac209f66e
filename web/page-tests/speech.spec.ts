// Needs a studio with ears and a voice, and MIC=FILE.wav with a sentence that the browser takes for its microphone.

import { chromium, expect, test } from "@playwright/test";
import { CHROMIUM, SOFTWARE } from "./chromium.ts";

const MIC = process.env.MIC ?? "";
const STUDIO = process.env.STUDIO_URL ?? "";

test("what is said into the microphone is done, and she says so", async () => {
  test.skip(!MIC, "no sound to say");
  const browser = await chromium.launch({
    executablePath: CHROMIUM,
    args: [
      ...SOFTWARE,
      "--use-fake-ui-for-media-stream",
      "--use-fake-device-for-media-stream",
      `--use-file-for-fake-audio-capture=${MIC}%noloop`,
      "--autoplay-policy=no-user-gesture-required",
    ],
  });
  try {
    const context = await browser.newContext({ permissions: ["microphone"], viewport: { width: 1440, height: 900 } });
    const page = await context.newPage();
    const sounds: string[] = [];
    page.on("response", (answer) => {
      if (/\/said\/.+\.wav$/.test(answer.url()) && answer.ok()) sounds.push(answer.url());
    });
    const made = await context.request.post(new URL("api/rooms", STUDIO).href, {
      data: { scene: "s1", model: "baseline", profile: "paper", labeling: "sem", figure: "mara" },
    });
    const { room } = (await made.json()) as { room: string };
    await page.goto(`${STUDIO}#room=${room}`);
    await expect(page.locator(".state")).toContainText("Ready", { timeout: 60_000 });
    await page.getByRole("button", { name: "Speak to me" }).click();
    await page.getByRole("button", { name: "Listen to me" }).click();
    await expect(page.locator(".said").first()).toContainText(/plate on the floor/i, { timeout: 60_000 });
    await expect(page.locator(".deed.done, .deed.corrected").first()).toContainText("Plate", { timeout: 60_000 });
    await expect(page.locator(".said.hers").last()).toContainText(/floor/i, { timeout: 90_000 });
    await expect.poll(() => sounds.length, { timeout: 30_000 }).toBeGreaterThan(0);
  } finally {
    await browser.close();
  }
});
