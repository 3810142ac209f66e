"""Whether an engine keeps the contract: run it on your own before a model lives in it."""

from adamo_vh.service.conformance.running import (
    CHECKS,
    Conformance,
    Finding,
    Verdict,
    conform,
    engine_faults,
)

__all__ = ["CHECKS", "Conformance", "Finding", "Verdict", "conform", "engine_faults"]
