"""Which way a request goes: straight, through a proxy, or not at all.

Loopback and private addresses are never asked for through a proxy: it cannot reach them, and
prompts, pictures and keys are none of its business. With the switch ADAMO_VH_NO_REMOTE nothing
leaves this machine, whoever asks for it.
"""

from __future__ import annotations

import importlib.util
import ipaddress
import os
from collections.abc import Iterator
from urllib.parse import urlsplit
from urllib.request import getproxies, proxy_bypass

from adamo_vh.errors import ModelConfigError
from adamo_vh.inference.redaction import redacted
from adamo_vh.inference.remote.endpoint import NO_REMOTE, Endpoint, key_problems, remote_forbidden
from adamo_vh.serving.loopback import is_loopback

_SCHEMES = ("http", "https", "socks5", "socks5h")
_LOCAL_NAMES = (".local", ".localhost", ".internal", ".home.arpa", ".lan")
_CERTIFICATES = ("SSL_CERT_FILE", "SSL_CERT_DIR")


def is_near(host: str) -> bool:
    """Whether a host is on this machine or in its own network, where no proxy belongs."""
    if is_loopback(host):
        return True
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        name = host.rstrip(".").lower()
        return "." not in name or name.endswith(_LOCAL_NAMES)
    return address.is_private or address.is_link_local


def proxy_for(url: str) -> str | None:
    """The proxy that the environment names for an address; None to go straight.

    Raises:
        ModelConfigError: The switch forbids the address, or the proxy cannot be used.
    """
    parts = urlsplit(url)
    host = parts.hostname or ""
    if remote_forbidden() and not is_loopback(host):
        raise ModelConfigError(f"{host} is not this machine, and {NO_REMOTE} forbids all others.")
    if is_near(host) or proxy_bypass(host):
        return None
    proxies = getproxies()
    name = parts.scheme if proxies.get(parts.scheme) else "all"
    proxy = proxies.get(name)
    if not proxy:
        return None
    if problem := _proxy_problem(name, proxy):
        raise ModelConfigError(problem)
    return proxy if "://" in proxy else f"http://{proxy}"


def check_way(endpoint: Endpoint) -> None:
    """Make sure that requests to an endpoint can be sent, before any is.

    Raises:
        ModelConfigError: A key, a proxy or a certificate in the environment is wrong.
    """
    problems = [*key_problems(endpoint.key_variables)]
    address = endpoint.base_url or "https://api.example.com"
    if urlsplit(address).scheme == "https":
        problems += certificate_problems()
    if problems:
        raise ModelConfigError(problems[0])
    if not (remote_forbidden() and endpoint.base_url is None):
        proxy_for(address)


def environment_problems() -> list[str]:
    """What in the environment keeps models from being reached, a sentence with the fix each."""
    named = [(name, proxy) for name, proxy in getproxies().items() if name in _PROXIES]
    proxies = [problem for name, proxy in named if (problem := _proxy_problem(name, proxy))]
    return [*proxies, *certificate_problems(), *key_problems()]


_PROXIES = ("http", "https", "all")


def _proxy_problem(name: str, proxy: str) -> str:
    """Why a proxy cannot be used, and what helps; empty if it can."""
    variable = next((v for v in (f"{name}_proxy", f"{name.upper()}_PROXY") if v in os.environ), "")
    shown, scheme = f"{variable or 'The proxy'} is {redacted(proxy)}", urlsplit(proxy).scheme
    if "://" not in proxy:
        return ""
    if scheme == "socks":
        fixed = redacted(f"socks5{proxy.removeprefix('socks')}")
        return f"{shown}: there is no scheme socks; write {fixed}, or unset it."
    if scheme not in _SCHEMES:
        return f"{shown}: {scheme} is no kind of proxy; use http, https, socks5 or socks5h."
    if scheme.startswith("socks") and importlib.util.find_spec("socksio") is None:
        return f"{shown}: SOCKS proxies need an extra package: pip install socksio. Or unset it."
    try:
        valid = bool(urlsplit(proxy).hostname) and urlsplit(proxy).port != 0
    except ValueError:
        valid = False
    return "" if valid else f"{shown}: write it like http://127.0.0.1:3128, or unset it."


def certificate_problems() -> Iterator[str]:
    """What is wrong with the certificates that the environment names."""
    for name in _CERTIFICATES:
        path = os.environ.get(name)
        if not path:
            continue
        there = os.path.isdir(path) if name.endswith("DIR") else os.path.isfile(path)
        if not there:
            what = "is not there"
        elif name.endswith("FILE") and not _holds_certificates(path):
            what = "holds no certificates"
        else:
            continue
        yield f"{name} names {redacted(path)}, which {what}; correct or unset it."


def _holds_certificates(path: str) -> bool:
    import ssl

    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT).load_verify_locations(cafile=path)
    except (OSError, ValueError):
        return False
    return True
