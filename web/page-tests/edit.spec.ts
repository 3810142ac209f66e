import type { Page } from "@playwright/test";
import { drawn, expect, test } from "./studio.ts";

interface Edited {
  editor: {
    picture: {
      middleOf: (ref: unknown) => { project: (camera: unknown) => { x: number; y: number } } | null;
      orbit: { camera: unknown };
    };
    draft: { selected: unknown };
  };
}

/** Where the selected thing is on the screen. */
async function placeOfSelected(page: Page): Promise<{ x: number; y: number }> {
  const at = await page.evaluate(() => {
    const { picture, draft } = (globalThis as unknown as Edited).editor;
    const seen = picture.middleOf(draft.selected)?.project(picture.orbit.camera);
    return { x: seen?.x ?? 9, y: seen?.y ?? 9 };
  });
  const area = await page.locator(".stage canvas").boundingBox();
  if (!area) throw new Error("There is no picture.");
  return { x: area.x + ((at.x + 1) / 2) * area.width, y: area.y + ((1 - at.y) / 2) * area.height };
}

test("a scene is edited, mended, saved and entered", async ({ page }) => {
  await page.goto("?debug");
  await page.getByLabel("Room", { exact: true }).selectOption("s1");
  await page.getByRole("button", { name: "Edit a scene" }).click();
  await drawn(page);
  const chosen = page.getByRole("region", { name: "Selected" });
  const findings = page.getByRole("region", { name: "Findings" });
  await expect(findings).toContainText("Nothing is wrong.");

  await page.getByRole("button", { name: "table", exact: true }).click();
  await page.getByText("Objects", { exact: true }).first().click();
  await page.getByRole("button", { name: "Add Apple" }).click();
  await expect(chosen.getByRole("heading")).toHaveText("Apple 58");
  await expect(chosen.getByLabel("On")).toHaveValue("table");
  await expect(findings).toContainText("Nothing is wrong.");

  await chosen.getByLabel("x (m)").fill("40");
  await expect(findings.getByRole("button")).toContainText("Apple 58");
  await page.getByRole("button", { name: "cup 45" }).click();
  await findings.getByRole("button").click();
  await expect(chosen.getByRole("heading")).toHaveText("Apple 58");
  await page.getByRole("button", { name: "Undo the edit" }).click();
  await expect(findings).toContainText("Nothing is wrong.");

  const name = `edited-${Date.now()}`;
  await page.getByLabel("Title").fill("A room of mine");
  await page.getByLabel("Save as").fill(name);
  await page.getByRole("button", { name: "Save", exact: true }).click();
  await expect(page.getByText(`Saved as ${name}.toml.`)).toBeVisible();
  await page.getByRole("button", { name: "Open a room here" }).click();
  await expect(page.getByRole("dialog").getByLabel("Room", { exact: true })).toHaveValue(`${name}.toml`);
  await page.getByRole("button", { name: "Open the room" }).click();
  await drawn(page);
  await expect(page.locator(".badge")).toHaveText("Live");
  await expect(page.locator(".where")).toContainText("A room of mine");
});

test("things are moved by pointer and by keyboard", async ({ page }) => {
  await page.goto("?debug#edit=s1");
  await drawn(page);
  const chosen = page.getByRole("region", { name: "Selected" });
  await page.getByRole("button", { name: "Plate 57" }).click();
  const [x, y, turned] = ["x (m)", "y (m)", "Turned (degrees)"].map((label) => chosen.getByLabel(label));
  if (!x || !y || !turned) throw new Error("There are no fields.");

  await page.locator(".stage canvas").focus();
  await page.keyboard.press("r");
  await expect(turned).toHaveValue("-75");
  await page.keyboard.press("Shift+R");
  await expect(turned).toHaveValue("-90");
  const [before, beside] = [await x.inputValue(), await y.inputValue()];
  await page.keyboard.press("ArrowUp");
  expect([await x.inputValue(), await y.inputValue()]).not.toEqual([before, beside]);
  await page.keyboard.press("ArrowDown");
  expect(Number(await x.inputValue())).toBeCloseTo(Number(before), 1);

  const from = await placeOfSelected(page);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(from.x - 160, from.y + 140, { steps: 6 });
  await page.mouse.up();
  await expect(chosen.getByLabel("On")).toHaveValue("floor");
  await page.keyboard.press("Control+z");
  await expect(chosen.getByLabel("On")).toHaveValue("table");
  await page.keyboard.press("Delete");
  await expect(page.getByRole("button", { name: "Plate 57" })).toHaveCount(0);
  await page.reload();
  await drawn(page);
  await expect(page.locator(".badge")).toHaveText("Your edits are back");
  await expect(page.getByRole("button", { name: "Plate 57" })).toHaveCount(0);
});
