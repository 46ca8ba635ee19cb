"""The page in another language: headings, captions and verdicts, from one file of words for each language.

The words stand in the templates and functions in English, and are looked up as they stand there. What a file lacks is
shown in English, so that a page is never wrong for want of a word. Numbers, names, texts of the user and messages with
their codes stay as they are.
"""

from fatigue.report.language.language import ENGLISH, Language, language_named, languages

__all__ = ["ENGLISH", "Language", "language_named", "languages"]
