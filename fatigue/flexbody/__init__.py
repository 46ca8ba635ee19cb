"""The flexible body as a dynamic system: modal mass, participation, flexibility.

``mass`` has effective modal mass and dynamic mass, ``flexibility`` the flexibility index of loaded points and the
independent directions of their interface modes.
"""
