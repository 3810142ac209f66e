// Writes which source a built page was made from, so that a test can tell a stale build.

import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Plugin } from "vite";

const root = join(import.meta.dirname, "..");

/** Files that make the page, relative to web/, sorted. */
export function sources(): string[] {
  const inside = readdirSync(join(root, "src"), { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => join(entry.parentPath, entry.name).slice(root.length + 1));
  return [...inside, "index.html", "package-lock.json"].sort();
}

/** SHA-256 over each file's name, a zero byte, its content, a zero byte. */
export function digest(): string {
  const hash = createHash("sha256");
  for (const name of sources()) {
    hash.update(`${name}\0`);
    hash.update(readFileSync(join(root, name)));
    hash.update("\0");
  }
  return hash.digest("hex");
}

export function sourceDigest(): Plugin {
  let folder = "";
  return {
    name: "source-digest",
    apply: "build",
    configResolved: (config) => {
      folder = config.build.outDir;
    },
    closeBundle: () => writeFileSync(join(root, folder, "source.txt"), `${digest()}\n`),
  };
}
