"""Welds, stations and faces of one result that another has at the same place."""
