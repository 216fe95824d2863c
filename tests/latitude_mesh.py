"""Triangles between the circles of latitude of a sphere, and OFF files of them, for tests that run programs."""


def faces_of(n):
    """Faces over the points: the north pole, n - 1 circles of 2 n points, the south pole."""
    last = 1 + 2 * n * (n - 1)
    at = lambda i, j: 0 if i == 0 else last if i == n else 1 + (i - 1) * 2 * n + j % (2 * n)
    faces = []
    for i in range(n):
        for j in range(2 * n):
            if i > 0:
                faces.append((at(i, j), at(i + 1, j), at(i, j + 1)))
            if i < n - 1:
                faces.append((at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)))
    return faces


def write_off(path, points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [" ".join(repr(x) for x in p) for p in points] + ["3 %d %d %d" % f for f in faces]
    path.write_text("\n".join(lines) + "\n")
