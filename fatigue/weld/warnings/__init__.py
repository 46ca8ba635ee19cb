"""What is possible about a weld line and hardly meant: turned normals, forgotten ends, corners of summed forces."""
