"""What is shown of one point, be it the worst of a weld in the report or any point on a page of its own."""
