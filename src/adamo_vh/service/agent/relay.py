"""Runs inside the box, without the package: a way from its own loopback to the sockets outside.

Started as ``python -I -c SOURCE PORT=SOCKET ... -- COMMAND``: passes connections to each port on to
the socket beside it, runs the command, and ends with its exit code.
"""

import asyncio
import sys

_CHUNK = 65536


async def _pump(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    try:
        while data := await reader.read(_CHUNK):
            writer.write(data)
            await writer.drain()
        writer.write_eof()
    except (ConnectionError, OSError):
        writer.close()


async def _forward(port: int, path: str) -> asyncio.Server:
    async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            there, back = await asyncio.open_unix_connection(path)
            await asyncio.gather(_pump(reader, back), _pump(there, writer))
            back.close()
        finally:
            writer.close()

    return await asyncio.start_server(serve, "127.0.0.1", port)


async def main(arguments: list[str]) -> int:
    """Relay while the command runs; its exit code, or 128 and the number of the signal."""
    split = arguments.index("--")
    servers = []
    for pair in arguments[:split]:
        port, _, path = pair.partition("=")
        servers.append(await _forward(int(port), path))
    try:
        program = await asyncio.create_subprocess_exec(*arguments[split + 1 :])
    except OSError as error:
        print(f"{arguments[split + 1]} cannot be started: {error.strerror}.", file=sys.stderr)
        return 127
    code = await program.wait()
    return code if code >= 0 else 128 - code


if __name__ == "__main__":
    sys.exit(asyncio.run(main(sys.argv[1:])))
