"""Regions carried by maps, and their areas."""

from verify.execution.study import Section, Study
from verify.studies.regions.findings import flows_of
from verify.studies.regions.plan import need_flows

_SECTION = Section(
    7,
    "regions carried by maps, and their areas",
    "the scene has no [[flow]]",
    lambda scene: scene.flow,
)
STUDY = Study(
    8,
    (_SECTION,),
    need=need_flows,
    found=lambda scene, results: {"flows": flows_of(scene, results)},
)
