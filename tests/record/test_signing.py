"""Signatures: keys as openssl and ssh-keygen make them, and what is no such key."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.keys import key_file, public_key_file

from adamo_vh.errors import ConfigError, FileError
from adamo_vh.record.digest import Signature
from adamo_vh.record.signing import Signer, fingerprint, is_signed, read_public_key


@pytest.mark.parametrize("form", ["PKCS8", "OpenSSH"])
def test_what_is_signed_is_found_good_and_nothing_else_is(tmp_path: Path, form: str) -> None:
    signer = Signer(key_file(tmp_path / "key", form))
    signed = signer.sign("result", "ab" * 32)
    assert is_signed("result", "ab" * 32, signed)
    assert not is_signed("result", "ac" * 32, signed)
    assert not is_signed("chain", "ab" * 32, signed)
    other = Signer(key_file(tmp_path / "other"))
    assert not is_signed("result", "ab" * 32, Signature(other.key, signed.value))
    for odd in ("", "%", "AAAA"):
        assert not is_signed("result", "ab" * 32, Signature(odd, signed.value))
        assert not is_signed("result", "ab" * 32, Signature(signed.key, odd))


def test_a_public_key_is_read_in_any_form(tmp_path: Path) -> None:
    private = key_file(tmp_path / "key")
    forms = [private, *(public_key_file(private, form) for form in ("PEM", "OpenSSH"))]
    assert {read_public_key(path) for path in forms} == {Signer(private).key}
    assert fingerprint(Signer(private).key).startswith("SHA256:")


def test_what_is_no_key_is_told_with_the_command_that_makes_one(tmp_path: Path) -> None:
    from cryptography.hazmat.primitives import serialization as s
    from cryptography.hazmat.primitives.asymmetric import ec, ed25519

    pem, form = s.Encoding.PEM, s.PrivateFormat.PKCS8
    elliptic = ec.generate_private_key(ec.SECP256R1())
    locked = s.BestAvailableEncryption(b"word")
    other = tmp_path / "other"
    other.write_bytes(elliptic.private_bytes(pem, form, s.NoEncryption()))
    kept = tmp_path / "kept"
    kept.write_bytes(ed25519.Ed25519PrivateKey.generate().private_bytes(pem, form, locked))
    text = tmp_path / "text"
    text.write_text("no key")
    for path, said in ((other, "another kind"), (kept, "pass phrase"), (text, "no such key")):
        with pytest.raises(ConfigError, match=said) as caught:
            Signer(path)
        assert "openssl genpkey -algorithm ed25519" in str(caught.value)
        assert "\n" not in str(caught.value)
    with pytest.raises(ConfigError, match="openssl pkey"):
        read_public_key(text)
    with pytest.raises(FileError, match="missing"):
        Signer(tmp_path / "missing")
