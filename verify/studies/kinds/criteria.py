"""The paper's four criteria, which are judged from proofs and the grid's runs."""

from verify.execution.plan import SceneQuestion, Study

_SECTION = SceneQuestion(
    5, "criteria 1–4", "the scene names no criteria", lambda scene: scene.criteria
)
STUDY = Study(6, (_SECTION,))
