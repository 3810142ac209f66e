// Puts a small script of its own before the page's: it asks for a run as soon as its name is known.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import type { Plugin } from "vite";

const FILE = join(import.meta.dirname, "../src/early.js");
const NAME = "assets/early.js";

export function early(): Plugin {
  return {
    name: "early",
    apply: "build",
    generateBundle() {
      this.emitFile({ type: "asset", fileName: NAME, source: readFileSync(FILE) });
    },
    transformIndexHtml: () => [{ tag: "script", attrs: { async: true, src: `./${NAME}` }, injectTo: "head" }],
  };
}
