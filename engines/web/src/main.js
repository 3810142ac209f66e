// The page: whoever opens it is the engine. It dials in where it came from, or at ?engine=ws://HOST:PORT/engine.

import { Engine } from "@babylonjs/core/Engines/engine.js";
import { PageEngine } from "./engine.js";
import { dial } from "./line.js";
import { Physics } from "./physics.js";
import { Stage } from "./stage.js";

const AGAIN_MS = 2000;
const QUIET_MS = 300;
const status = document.getElementById("status");
const tell = (text) => (status.textContent = text);
const asked = new URLSearchParams(location.search);
const address = asked.get("engine") ?? `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/engine`;

async function fetchScene(name) {
  if (!/^\w[\w-]*$/.test(name)) throw new Error(`${name} is no name of a scene here.`);
  const base = `scenes/${name}`;
  const answer = await fetch(`${base}/scene.json`);
  if (!answer.ok) throw new Error(`scene ${name} is not here: adamo-vh scenes export ${name} --out scenes/${name}`);
  return { told: await answer.json(), base };
}

const stage = new Stage(document.getElementById("eyes"));
const engine = new PageEngine(stage, fetchScene, (made, world) => Physics.made(made, world, "HavokPhysics.wasm"), showSoon);

let soon = 0;

/** Show what the eyes see, unless a picture is asked for first. */
function showSoon() {
  clearTimeout(soon);
  soon = setTimeout(() => {
    stage.aim(engine.view());
    stage.scene.render();
  }, QUIET_MS);
}

for (;;) {
  tell(`dialling ${address}`);
  const why = await dial(address, engine, `Babylon.js ${Engine.Version} with Havok`, (text) => tell(`${address}: ${text}`));
  tell(`${why}; trying again`);
  await new Promise((done) => setTimeout(done, AGAIN_MS));
}
