// The line to ADAMO: hello first, then each request in its turn, and its answer with what follows it.

/** The answer to one text message, as texts and binary messages in the order in which they go out. */
export async function answered(engine, message) {
  let id = null;
  try {
    const request = JSON.parse(message);
    id = request.id ?? null;
    const { result, pictures } = await engine.answer(String(request.method), request.params ?? {});
    return [JSON.stringify({ jsonrpc: "2.0", id, result, attachments: pictures.length }), ...pictures];
  } catch (error) {
    // A mistake of the engine's own must not end the page.
    return [JSON.stringify({ jsonrpc: "2.0", id, error: { code: 1, message: String(error?.message ?? error) } })];
  }
}

/**
 * Dial in, and answer until the other side hangs up.
 * @returns A promise of why it ended.
 */
export function dial(address, engine, name, tell = () => {}) {
  return new Promise((ended) => {
    const socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    let turn = Promise.resolve();
    socket.onopen = () => {
      tell("dialled in");
      socket.send(JSON.stringify({ jsonrpc: "2.0", method: "hello", params: engine.hello(name) }));
    };
    socket.onmessage = ({ data }) => {
      turn = turn.then(async () => {
        for (const part of await answered(engine, data)) socket.send(part);
        tell(JSON.parse(data).method);
      });
    };
    socket.onclose = ({ reason, wasClean }) => ended(reason || (wasClean ? "hung up" : "nobody waits there"));
  });
}
