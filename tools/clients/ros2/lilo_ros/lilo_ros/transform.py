# SPDX-License-Identifier: BSD-3-Clause
"""Rigid motions and what they do to poses, twists and covariances. Quaternions are x y z w."""


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def multiply(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz)


def matrix(q):
    x, y, z, w = q
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))


def rotated(q, v):
    return tuple(sum(row[k] * v[k] for k in range(3)) for row in matrix(q))


class Transform:
    """T_a_b: takes coordinates in b to coordinates in a."""

    def __init__(self, position=(0.0, 0.0, 0.0), rotation=(0.0, 0.0, 0.0, 1.0)):
        self.position = tuple(position)
        self.rotation = tuple(rotation)

    def __matmul__(self, other):
        moved = rotated(self.rotation, other.position)
        return Transform([a + b for a, b in zip(self.position, moved)],
                         multiply(self.rotation, other.rotation))

    def inverse(self):
        x, y, z, w = self.rotation
        back = (-x, -y, -z, w)
        return Transform([-v for v in rotated(back, self.position)], back)

    def adjoint(self):
        """6x6: a small motion (x y z rx ry rz) seen in b becomes the same one seen in a."""
        r = matrix(self.rotation)
        t = self.position
        turned = [cross(t, [r[row][column] for row in range(3)]) for column in range(3)]
        lever = [[turned[column][row] for column in range(3)] for row in range(3)]
        return ([list(r[k]) + lever[k] for k in range(3)] +
                [[0.0] * 3 + list(r[k]) for k in range(3)])


def congruent(a, c):
    """a c a^T of 6x6: `a` as rows, `c` and the result row-major in one list."""
    half = [[sum(a[i][k] * c[6 * k + j] for k in range(6)) for j in range(6)] for i in range(6)]
    return [sum(half[i][k] * a[j][k] for k in range(6)) for i in range(6) for j in range(6)]


def turned(q, c):
    """A covariance about other axes: the blocks turned by `q`, no lever arm."""
    return congruent(Transform(rotation=q).adjoint(), c)
