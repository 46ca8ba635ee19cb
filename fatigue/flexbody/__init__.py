"""The flexible body as a dynamic system: finite elements, condensation, modal mass, participation, flexibility.

``elements`` has stiffness and mass of flat shells and of a beam, ``shell`` and ``structure`` the matrices K and M of
a whole body, ``factor`` and ``modes`` solve it free or held, ``condensation`` has the bases that reduce it, ``mass``
effective modal mass and dynamic mass, ``flexibility`` the flexibility index of loaded points and the independent
directions of their interface modes.
"""
