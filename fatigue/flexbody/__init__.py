"""The flexible body as a dynamic system: modal mass, participation, flexibility.

``mass`` has effective modal mass and dynamic mass.
"""
