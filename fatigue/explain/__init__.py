"""What a code of a warning or a refusal means, why it matters, what to do, and where it arises.

``explanation`` makes the page of one code, ``all_codes`` lists them. Warnings are told by hand in ``warnings.toml``,
family by family. Refusals say what they mean where they are made: ``told.json`` is collected from there by
``python -m tests.reference``, and ``refusals.toml`` has the few whose words are composed of what is found.
"""

from fatigue.explain.codes import Explanation, Place, all_codes, explanation, near

__all__ = ["Explanation", "Place", "all_codes", "explanation", "near"]
