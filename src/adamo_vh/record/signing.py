"""Signatures by Ed25519, for which the extra `sign` is needed."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from adamo_vh.errors import ConfigError
from adamo_vh.files import read_text
from adamo_vh.record.digest import Signature

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

_MAKE = "openssl genpkey -algorithm ed25519 -out FILE"
_SHOW = "openssl pkey -in KEYFILE -pubout -out FILE"


class Signer:
    """Signs with a private key, which never leaves this object."""

    def __init__(self, path: Path) -> None:
        """Read a key.

        Args:
            path: An Ed25519 private key without a pass phrase, as PEM or in the form of OpenSSH.

        Raises:
            ConfigError: The extra `sign` is missing, or the file holds no such key.
            FileError: The file cannot be read.
        """
        self._key: Ed25519PrivateKey = _private(path)
        self.key = _coded(self._key.public_key().public_bytes_raw())
        """The public key, as in `Signature.key`."""

    def sign(self, purpose: str, digest: str) -> Signature:
        """Sign a digest.

        Args:
            purpose: What the digest is of, so that no signature serves for something else.
            digest: In hex.
        """
        return Signature(self.key, _coded(self._key.sign(_message(purpose, digest))))


def is_signed(purpose: str, digest: str, signature: Signature) -> bool:
    """Whether a signature is that of its key over a digest.

    Raises:
        ConfigError: The extra `sign` is missing.
    """
    _need()
    from cryptography.exceptions import InvalidSignature
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

    try:
        key = Ed25519PublicKey.from_public_bytes(base64.b64decode(signature.key, validate=True))
        key.verify(base64.b64decode(signature.value, validate=True), _message(purpose, digest))
    except (ValueError, InvalidSignature):
        return False
    return True


def read_public_key(path: Path) -> str:
    """A public key, as in `Signature.key`.

    Args:
        path: An Ed25519 public key as PEM or in the form of OpenSSH; a private one will do.

    Raises:
        ConfigError: The extra `sign` is missing, or the file holds no such key.
        FileError: The file cannot be read.
    """
    _need()
    from cryptography.hazmat.primitives import serialization
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

    text = read_text(path)
    if "PRIVATE KEY" in text:
        return _coded(_private(path).public_key().public_bytes_raw())
    is_ssh = text.startswith("ssh-")
    load = serialization.load_ssh_public_key if is_ssh else serialization.load_pem_public_key
    key = _loaded(load, text.encode(), path, f"Make one: {_SHOW}")
    if not isinstance(key, Ed25519PublicKey):
        raise ConfigError(f"{path} holds a key of another kind than Ed25519. Make one: {_SHOW}")
    return _coded(key.public_bytes_raw())


def fingerprint(key: str) -> str:
    """A public key in a few letters, the way ssh-keygen shows one."""
    raw = base64.b64decode(key)
    kind = b"ssh-ed25519"
    blob = len(kind).to_bytes(4, "big") + kind + len(raw).to_bytes(4, "big") + raw
    return f"SHA256:{_coded(hashlib.sha256(blob).digest()).rstrip('=')}"


def _private(path: Path) -> Ed25519PrivateKey:
    _need()
    from cryptography.hazmat.primitives import serialization
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

    text = read_text(path)
    is_ssh = "OPENSSH PRIVATE KEY" in text
    load = serialization.load_ssh_private_key if is_ssh else serialization.load_pem_private_key
    key = _loaded(lambda data: load(data, password=None), text.encode(), path, f"Make one: {_MAKE}")
    if not isinstance(key, Ed25519PrivateKey):
        raise ConfigError(f"{path} holds a key of another kind than Ed25519. Make one: {_MAKE}")
    return key


def _loaded(load: Callable[[bytes], Any], data: bytes, path: Path, fix: str) -> Any:
    from cryptography.exceptions import UnsupportedAlgorithm

    try:
        return load(data)
    except TypeError:
        raise ConfigError(
            f"{path} is kept under a pass phrase, which nobody is asked for. {fix}"
        ) from None
    except (ValueError, UnsupportedAlgorithm):
        raise ConfigError(f"{path} holds no such key. {fix}") from None


def _need() -> None:
    try:
        import cryptography  # noqa: F401
    except ImportError:
        raise ConfigError(
            'Signatures need the extra "sign": pip install "adamo-vh[sign]"'
        ) from None


def _message(purpose: str, digest: str) -> bytes:
    return f"adamo-vh {purpose} 1\n{digest}\n".encode()


def _coded(data: bytes) -> str:
    return base64.b64encode(data).decode()
