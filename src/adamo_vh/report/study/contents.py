"""The sections of a report, in the order in which they are read."""

from __future__ import annotations

from adamo_vh.report.study.ablations import ablations
from adamo_vh.report.study.averages import averages
from adamo_vh.report.study.comparing import comparing
from adamo_vh.report.study.effort import conduct, effort
from adamo_vh.report.study.every_cell import every_cell
from adamo_vh.report.study.failing import failing
from adamo_vh.report.study.headline import headline
from adamo_vh.report.study.labelings import labelings
from adamo_vh.report.study.levels import levels
from adamo_vh.report.study.material import Material
from adamo_vh.report.study.per_task import per_task, what_is_asked
from adamo_vh.report.study.section import Section


def sections(material: Material) -> tuple[Section, ...]:
    """Every section that has something to say."""
    found = (
        headline(material),
        comparing(material),
        per_task(material),
        averages(material),
        labelings(material),
        levels(material),
        failing(material),
        ablations(material),
        effort(material),
        conduct(material),
        what_is_asked(material),
        every_cell(material),
    )
    return tuple(section for section in found if section is not None)
