"""Why an episode failed: class, fine code and evidence, from the simulator's truth."""

from adamo_vh.analysis.diagnosis.diagnosing import diagnose
from adamo_vh.analysis.diagnosis.finding import (
    Code,
    Diagnosis,
    Evidence,
    FailureClass,
    load_diagnosis,
    read_diagnosis,
)

__all__ = [
    "Code",
    "Diagnosis",
    "Evidence",
    "FailureClass",
    "diagnose",
    "load_diagnosis",
    "read_diagnosis",
]
