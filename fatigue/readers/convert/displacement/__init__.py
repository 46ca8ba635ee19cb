"""An elastic displacement of the simulation as a proof of modal coordinates: read, compared, judged.

``record`` reads it, ``side_by_side`` puts it beside the sum of the modes as a ``comparison``, ``causes``, ``timing``
and ``nodes`` look for what explains a misfit, ``verdict`` makes a row of the audit of it, and ``check`` is the story.
"""
