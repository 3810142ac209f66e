"""A library that is missing is told with the command that brings it; a fault of ours is not one."""

from __future__ import annotations

import pytest

from adamo_vh.errors import ConfigError
from adamo_vh.extras import extra, needed


def test_what_is_missing_is_told_with_the_command() -> None:
    told = r"^The page needs .*\(zz\).*'adamo-vh\[serve\]'\.$"
    with pytest.raises(ConfigError, match=told), extra("serve", "The page"):
        raise ImportError("no", name="zz")
    with pytest.raises(ConfigError, match=r"\(no_such_module\).*'adamo-vh\[gym\]'"):
        needed("no_such_module", "gym")
    needed("json", "gym")


def test_a_fault_of_ours_is_no_missing_library() -> None:
    with pytest.raises(ImportError), extra("serve", "The page"):
        raise ImportError("no", name="adamo_vh.nowhere")
