"""The parts of the page: the whole body, one weld, the tables and the method, each as data for a template."""
