import AxeBuilder from "@axe-core/playwright";
import { drawn, expect, test } from "./studio.ts";

const RUN = process.env.STUDIO_RUN ?? "run";
const SIZES = [
  { name: "wide", width: 1440, height: 900 },
  { name: "narrow", width: 390, height: 844 },
] as const;

for (const size of SIZES) {
  for (const colorScheme of ["light", "dark"] as const) {
    test(`${size.name} and ${colorScheme}: nothing that axe finds serious`, async ({ browser, baseURL }, info) => {
      const context = await browser.newContext({ baseURL, viewport: size, colorScheme });
      const page = await context.newPage();
      const check = async (what: string): Promise<void> => {
        await page.screenshot({ path: info.outputPath(`${what}-${size.name}-${colorScheme}.png`) });
        const { violations } = await new AxeBuilder({ page }).analyze();
        const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
        expect(serious.map(({ id, nodes }) => [id, nodes.map((node) => node.html)])).toEqual([]);
      };
      await page.goto("");
      await expect(page.getByLabel("Mind")).toBeVisible();
      await check("start");
      await page.goto(`?x#run=${encodeURIComponent(RUN)}`);
      await drawn(page);
      await page.waitForTimeout(3000);
      await check("replay");
      await page.goto("?y#edit=s2");
      await drawn(page);
      await page.getByRole("button", { name: "sofa", exact: true }).click();
      await page.waitForTimeout(3000);
      await check("editor");
      await context.close();
    });
  }
}
