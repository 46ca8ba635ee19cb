"""Slow, obviously right versions of the weld formulas: loops, dense matrices, adaptive quadrature."""

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq


def edge_list(line):
    """Edges as tuples of node positions, found by walking along the line."""
    n = line.node.size
    ends = [i for i in range(n) if not line.edge_mid[i]]
    found = []
    for k, begin in enumerate(ends):
        if k + 1 == len(ends) and not line.closed:
            break
        stop = ends[(k + 1) % len(ends)]
        found.append((begin, stop) if (begin + 1) % n == stop else (begin, (begin + 1) % n, stop))
    return found


def edge_functions(line, edge):
    """Shape functions of one edge and its |dx/dxi|, as functions of xi in [-1, 1]."""
    stations = np.linspace(-1, 1, len(edge))
    at_one_node = np.linalg.solve(np.vander(stations), np.eye(len(edge)))  # coefficients: 1 there, 0 at the others
    shape = [np.poly1d(coefficients) for coefficients in at_one_node.T]
    slope = [function.deriv() for function in shape]

    def speed(xi):
        return np.linalg.norm(sum(slope[i](xi) * line.xyz[node] for i, node in enumerate(edge)))

    return shape, slope, speed


def arc_length(line):
    """Arc length of every node by quadrature, and the whole length."""
    s, total = {}, 0.0
    for edge in edge_list(line):
        _, _, speed = edge_functions(line, edge)
        for node, xi in zip(edge, np.linspace(-1, 1, len(edge)), strict=True):
            s.setdefault(node, total + quad(speed, -1, xi, epsabs=1e-13)[0])
        total += quad(speed, -1, 1, epsabs=1e-13)[0]
    if line.closed and line.edge_mid[0]:
        s = {node: (value - s[0]) % total for node, value in s.items()}
    return np.array([s[node] for node in range(line.node.size)]), total


def line_load_matrix(line):
    """Dense consistent matrix by quadrature of every pair of shape functions."""
    A = np.zeros((line.node.size, line.node.size))
    for edge in edge_list(line):
        shape, _, speed = edge_functions(line, edge)
        for row, N_i in zip(edge, shape, strict=True):
            for column, N_j in zip(edge, shape, strict=True):

                def integrand(xi, N_i=N_i, N_j=N_j, speed=speed):
                    return N_i(xi) * N_j(xi) * speed(xi)

                A[row, column] += quad(integrand, -1, 1)[0]
    return A


def mean_load(line, load, stop):
    """Mean of a line load, (n,), over the arc length [0, stop]: edge by edge, up to where the arc ends."""
    total, start = 0.0, 0.0
    for edge in edge_list(line):
        shape, _, speed = edge_functions(line, edge)
        whole = quad(speed, -1, 1)[0]
        if start + whole > stop:
            rest = stop - start
            upper = brentq(lambda xi, speed=speed, rest=rest: quad(speed, -1, xi)[0] - rest, -1, 1, xtol=1e-13)
        else:
            upper = 1.0

        def integrand(xi, edge=edge, shape=shape, speed=speed):
            return sum(shape[i](xi) * load[node] for i, node in enumerate(edge)) * speed(xi)

        total += quad(integrand, -1, upper)[0]
        start += whole
        if start >= stop:
            break
    return total / stop


def local_axes(line):
    """Local axes node by node, by the words of the convention."""
    tangents = np.zeros((line.node.size, 3))
    for edge in edge_list(line):
        _, slope, _ = edge_functions(line, edge)
        for node, xi in zip(edge, np.linspace(-1, 1, len(edge)), strict=True):
            direction = sum(slope[i](xi) * line.xyz[other] for i, other in enumerate(edge))
            tangents[node] += direction / np.linalg.norm(direction)
    axes = []
    for tangent, normal, outward in zip(tangents, line.normal, line.outward, strict=True):
        z = normal / np.linalg.norm(normal)
        x = tangent - (tangent @ z) * z
        x /= np.linalg.norm(x)
        y = np.cross(z, x)
        if y @ outward < 0:
            y = -y
        axes.append([np.cross(y, z), y, z])
    return np.array(axes)
