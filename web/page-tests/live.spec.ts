import { drawn, expect, openRoom, placeOf, say, test } from "./studio.ts";

test("an instruction is done before one's eyes, and undone", async ({ page }) => {
  await openRoom(page);
  await say(page, "Pick the object tagged as 34");
  await expect(page.locator(".said").first()).toContainText("tagged as 34");
  await expect(page.locator(".deed.done, .deed.corrected").first()).toContainText("Key 34");
  await expect(page.locator(".said.hers").last()).toContainText("34");
  await expect(page.locator(".bubble")).toContainText("34");
  await page.getByRole("button", { name: "Undo" }).click();
  await expect(page.locator(".aside").last()).toContainText("back as it was");
});

test("she stops at once", async ({ page }) => {
  await openRoom(page);
  await say(page, "Pick the object tagged as 34");
  await expect(page.locator(".state")).toContainText("Acting");
  await page.getByRole("button", { name: "Stop" }).click();
  await expect(page.locator(".turns")).toContainText(/[Ss]topped/);
  await expect(page.locator(".state")).toContainText("Ready");
});

test("she asks before she acts, and hears an objection", async ({ page }) => {
  await openRoom(page, "baseline", true);
  await say(page, "Pick the object tagged as 34");
  await expect(page.getByRole("alertdialog")).toContainText("Pick up Key 34");
  await page.getByLabel("Why you object").fill("not that one");
  await page.getByRole("button", { name: "Object" }).click();
  await expect(page.locator(".aside").last()).toContainText("You objected: not that one");
});

test("a thing is dragged elsewhere", async ({ page }) => {
  await openRoom(page);
  const id = 57;
  const from = await placeOf(page, id);
  const other = await placeOf(page, 8);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(other.x - 40, other.y + 10, { steps: 4 });
  await page.mouse.up();
  await expect(page.locator(".aside").last()).toContainText(/^You moved \S/);
});

test("a person is the mind, by clicking", async ({ page }) => {
  await openRoom(page, "human");
  await say(page, "Pick the object tagged as 34");
  await expect(page.locator(".state")).toContainText("Your turn");
  const key = await placeOf(page, 34);
  await page.getByRole("button", { name: "Pick", exact: true }).click();
  await page.mouse.click(key.x, key.y);
  await expect(page.locator(".deed").first()).toContainText(/Pick up|Look/);
  await expect(page.locator(".state")).toContainText("Your turn");
  await page.getByLabel("Final answer").fill("I have it.");
  await page.getByRole("button", { name: "Finish" }).click();
  await expect(page.locator(".said.hers").last()).toContainText("I have it.");
});

test("the keyboard suffices", async ({ page }) => {
  await openRoom(page);
  await page.locator(".stage canvas").focus();
  await page.keyboard.press("2");
  await expect(page.getByRole("button", { name: "Follow" })).toHaveAttribute("aria-pressed", "true");
  await page.keyboard.press("/");
  await expect(page.getByLabel("Tell her what to do")).toBeFocused();
  await drawn(page);
});
