"""Adams: results as XML, and tables with a legend."""
