import { defineConfig } from "vite";
import { early } from "./dev/early.ts";
import { fixtures } from "./dev/fixtures.ts";
import { policy } from "./dev/policy.ts";
import { sourceDigest } from "./dev/digest.ts";

export default defineConfig({
  base: "./",
  plugins: [fixtures(), policy(), early(), sourceDigest()],
  build: {
    outDir: "../src/adamo_vh/studio/page",
    emptyOutDir: true,
    target: "es2022",
    chunkSizeWarningLimit: 1200,
    rolldownOptions: {
      output: {
        entryFileNames: "assets/studio.js",
        chunkFileNames: "assets/[name].js",
        assetFileNames: "assets/[name][extname]",
        codeSplitting: { groups: [{ name: "three", test: /node_modules/ }] },
      },
    },
  },
});
