// Opens what the address asks for: #room=ID a live room, #run=NAME a replay, #compare=A,B two of them, #edit=SCENE the editor.

import "./style/main.css";
import { buildShell } from "./shell/shell.ts";
import { Router } from "./shell/router.ts";

const app = document.getElementById("app");
if (app) new Router(buildShell(app)).start();
