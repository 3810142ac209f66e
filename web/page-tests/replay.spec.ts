import { drawn, expect, stats, test } from "./studio.ts";

// Names of the runs that the server shows: an honest one, and one with markup in every text.
const RUN = process.env.STUDIO_RUN ?? "run";
const EVIL = process.env.STUDIO_EVIL_RUN ?? "evil";

test("a run is replayed, scrubbed and stepped through", async ({ page }) => {
  await page.goto(`?debug#run=${encodeURIComponent(RUN)}`);
  await drawn(page);
  await expect(page.locator(".badge")).toHaveText("Replay");
  await expect(page.locator(".turn").first()).toBeVisible();
  const time = page.getByLabel("Time", { exact: true });
  await time.fill("1000");
  await expect(page.locator(".turn.future")).toHaveCount(0);
  await time.fill("0");
  await page.getByRole("button", { name: "Step on" }).click();
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await page.waitForTimeout(6000);
  const told = await stats(page);
  console.log("frame figures on this machine:", JSON.stringify(told));
  expect(told.calls).toBeLessThanOrEqual(150);
  expect(told.triangles).toBeLessThanOrEqual(250_000);
});

test("meshes are asked for once, and before the track is there", async ({ page }) => {
  await page.goto(`?debug#run=${encodeURIComponent(RUN)}`);
  await drawn(page);
  const asked = await page.evaluate(() =>
    performance.getEntriesByType("resource").map((entry) => {
      const { name, startTime, responseEnd } = entry as PerformanceResourceTiming;
      return { name, startTime, responseEnd };
    }),
  );
  const [track] = asked.filter(({ name }) => name.endsWith("/track"));
  for (const part of ["scene.glb", "figure.glb"]) {
    const found = asked.filter(({ name }) => name.endsWith(part));
    expect(found).toHaveLength(1);
    expect(found[0]?.startTime).toBeLessThan(track?.responseEnd ?? 0);
  }
});

test("a long story does not lengthen the page", async ({ page }) => {
  await page.setViewportSize({ width: 1440, height: 600 });
  await page.goto(`?debug#run=${encodeURIComponent(RUN)}`);
  await drawn(page);
  await expect(page.locator(".said").last()).toBeAttached();
  expect(await page.evaluate(() => document.documentElement.scrollHeight)).toBe(600);
});

test("text of a record is shown as text alone", async ({ page }) => {
  await page.goto(`#run=${encodeURIComponent(EVIL)}`);
  await expect(page.locator(".turns")).toContainText("<img src=x");
  await expect(page.locator("#app img[src='x'], #app script, #app b b")).toHaveCount(0);
});

test("two runs go side by side on one time line", async ({ page }) => {
  await page.goto(`#compare=${encodeURIComponent(RUN)},${encodeURIComponent(RUN)}`);
  await expect(page.locator(".side canvas")).toHaveCount(2);
  await expect(page.locator(".side .loading")).toHaveCount(0);
});
