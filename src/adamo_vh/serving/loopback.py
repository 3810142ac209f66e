"""Addresses that only this machine can reach."""

from __future__ import annotations

import ipaddress
import socket

from adamo_vh.errors import ConfigError


def listen(host: str, port: int, *, locked: bool = False) -> socket.socket:
    """Open a socket, for this machine alone unless there is a lock.

    Args:
        host: A loopback address or "localhost"; any address of this machine, if it is locked.
        port: The port; 0 for a free one.
        locked: Whether nobody comes in without a token.

    Raises:
        ConfigError: Others could reach the host and nothing is locked, or the port cannot be had.
    """
    if not (locked or is_loopback(host)):
        raise ConfigError(
            f"{host} can be reached from other machines, and nothing is locked. "
            "Use 127.0.0.1, localhost or ::1, or a token where the server takes one."
        )
    if not 0 <= port <= 65535:
        raise ConfigError(f"{port} is no port; use 1 to 65535, or 0 for a free one.")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # Named, because asyncio sends at once (TCP_NODELAY) on what says that it is TCP alone: else the
    # second part of every answer waits 40 ms for a word about the first.
    opened = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        opened.bind((host, port))
        opened.listen(128)
    except OSError as error:
        opened.close()
        reason = error.strerror or type(error).__name__
        raise ConfigError(f"Port {port} of {host} cannot be had: {reason}. Try another.") from None
    return opened


def is_loopback(host: str) -> bool:
    """Whether a host name or address is this machine's own."""
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        return host.lower() == "localhost"
    mapped = getattr(address, "ipv4_mapped", None)
    return bool((mapped or address).is_loopback)
