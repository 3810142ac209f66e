"""Addresses that only this machine can reach."""

from __future__ import annotations

import ipaddress
import socket

from adamo_vh.errors import ConfigError


def listen(host: str, port: int) -> socket.socket:
    """Open a socket that takes connections from this machine alone.

    Args:
        host: A loopback address, or "localhost".
        port: The port; 0 for a free one.

    Raises:
        ConfigError: The host is not a loopback address, or the port cannot be had.
    """
    if not is_loopback(host):
        raise ConfigError(
            f"{host} can be reached from other machines, and a served model has no lock. "
            "Use 127.0.0.1, localhost or ::1."
        )
    if not 0 <= port <= 65535:
        raise ConfigError(f"{port} is no port; use 1 to 65535, or 0 for a free one.")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    opened = socket.socket(family, socket.SOCK_STREAM)
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
