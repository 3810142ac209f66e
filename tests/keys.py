"""Keys for tests of signatures."""

from __future__ import annotations

from pathlib import Path

from cryptography.hazmat.primitives import serialization as s
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey


def key_file(path: Path, form: str = "PKCS8") -> Path:
    """A new private key, as openssl (PKCS8) or ssh-keygen (OpenSSH) writes it."""
    key = Ed25519PrivateKey.generate()
    layout = getattr(s.PrivateFormat, form)
    path.write_bytes(key.private_bytes(s.Encoding.PEM, layout, s.NoEncryption()))
    return path


def public_key_file(private: Path, form: str = "PEM") -> Path:
    """The public key of a private one, in a file beside it."""
    key = s.load_pem_private_key(private.read_bytes(), password=None).public_key()
    kinds = {
        "PEM": (s.Encoding.PEM, s.PublicFormat.SubjectPublicKeyInfo),
        "OpenSSH": (s.Encoding.OpenSSH, s.PublicFormat.OpenSSH),
    }
    path = private.with_suffix(f".{form.lower()}.pub")
    path.write_bytes(key.public_bytes(*kinds[form]))
    return path
