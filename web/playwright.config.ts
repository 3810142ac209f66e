import { defineConfig } from "@playwright/test";
import { CHROMIUM, SOFTWARE } from "./page-tests/chromium.ts";

// STUDIO_URL is the address of a running studio, with the slash at its end; see tests/studio/test_page.py.
export default defineConfig({
  testDir: "page-tests",
  timeout: 240_000,
  expect: { timeout: 90_000 },
  workers: 1,
  retries: 0,
  reporter: [["list"]],
  outputDir: process.env.STUDIO_PICTURES ?? "test-results",
  use: {
    baseURL: process.env.STUDIO_URL,
    viewport: { width: 1440, height: 900 },
    launchOptions: {
      executablePath: CHROMIUM,
      args: SOFTWARE,
    },
  },
});
