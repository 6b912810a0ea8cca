"""Regions carried by maps, and their areas."""

from verify.execution.study import Study, toml_section
from verify.studies.regions.findings import flows_of
from verify.studies.regions.plan import need_flows

_SECTION = toml_section(7, "regions carried by maps, and their areas", "[[flow]]")
STUDY = Study(
    8,
    (_SECTION,),
    need=need_flows,
    found=lambda scene, results: {"flows": flows_of(scene, results)},
)
