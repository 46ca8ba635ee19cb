"""Sections about what is checked beside the normal stress at the toe, and about other assumptions."""
