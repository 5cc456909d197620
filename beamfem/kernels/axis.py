"""The beam axis at a quadrature point: q = (r0', d, third), third being d', or r0'' for the elastic line."""

from beamfem.kernels.compiling import kernel

FAST = {"contract", "reassoc", "nsz"}


@kernel(forceinline=True, fastmath=FAST)
def interpolate(nn, vpn, bends, block, element, kind, point, e):
    """Return q (6) from nodal vectors e (N, per_node); bends: third is r0''."""
    node, slope, second, director = block.node, block.slope, block.second, block.director
    rx, ry, dx, dy, ex, ey = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    last = vpn - 1
    for n in range(nn):
        own = node[element, n]
        for s in range(last):
            i = n * vpn + s
            x, y = e[own, 2 * s], e[own, 2 * s + 1]
            rx += slope[kind, point, i] * x
            ry += slope[kind, point, i] * y
            if bends:
                ex += second[kind, point, i] * x
                ey += second[kind, point, i] * y
        x, y = e[own, 2 * last], e[own, 2 * last + 1]
        dx += director[point, n] * x
        dy += director[point, n] * y
        if not bends:
            ex += slope[kind, point, n * vpn + last] * x
            ey += slope[kind, point, n * vpn + last] * y
    return rx, ry, dx, dy, ex, ey


@kernel(forceinline=True, fastmath=FAST)
def spread(nn, vpn, bends, block, element, kind, point, f, force):
    """Add what f (6) on q gives to the forces (N, per_node) of the nodes."""
    node, slope, second, director = block.node, block.slope, block.second, block.director
    fx, fy, mx, my, hx, hy = f
    last = vpn - 1
    for n in range(nn):
        own = node[element, n]
        for s in range(last):
            i = n * vpn + s
            x, y = slope[kind, point, i] * fx, slope[kind, point, i] * fy
            if bends:
                x += second[kind, point, i] * hx
                y += second[kind, point, i] * hy
            force[own, 2 * s] += x
            force[own, 2 * s + 1] += y
        x, y = director[point, n] * mx, director[point, n] * my
        if not bends:
            x += slope[kind, point, n * vpn + last] * hx
            y += slope[kind, point, n * vpn + last] * hy
        force[own, 2 * last] += x
        force[own, 2 * last + 1] += y


@kernel(forceinline=True, fastmath=FAST)
def spread_matrix(nn, vpn, bends, block, kind, point, h, k):
    """Add T^T h T to k (2 nv, 2 nv) for pairs of nodes n <= m, T the tables of q; h: see `measures.hessian`."""
    slope, second, director = block.slope, block.second, block.director
    rxx, rxy, ryy, axx, axy, ayx, ayy, bxx, bxy, byx, byy, dxx, dxy, dyy, gxx, gxy, gyx, gyy, exx, exy, eyy = h
    last = vpn - 1
    for m in range(nn):
        for t in range(vpn):
            j = m * vpn + t
            # columns of h times the table of vector j: rows of r, d and third
            w = slope[kind, point, j]
            if t == last:
                u = director[point, m]
                if bends:
                    w = 0.0
                r0, r1, r2, r3 = u * axx + w * bxx, u * axy + w * bxy, u * ayx + w * byx, u * ayy + w * byy
                d0, d1, d2, d3 = u * dxx + w * gxx, u * dxy + w * gxy, u * dxy + w * gyx, u * dyy + w * gyy
                t0, t1, t2, t3 = u * gxx + w * exx, u * gyx + w * exy, u * gxy + w * exy, u * gyy + w * eyy
            else:
                u = second[kind, point, j] if bends else 0.0
                r0, r1, r2, r3 = w * rxx + u * bxx, w * rxy + u * bxy, w * rxy + u * byx, w * ryy + u * byy
                d0, d1, d2, d3 = w * axx + u * gxx, w * ayx + u * gxy, w * axy + u * gyx, w * ayy + u * gyy
                t0, t1, t2, t3 = w * bxx + u * exx, w * byx + u * exy, w * bxy + u * exy, w * byy + u * eyy
            for n in range(m + 1):
                for s in range(last):
                    i = n * vpn + s
                    w = slope[kind, point, i]
                    u = second[kind, point, i] if bends else 0.0
                    k[2 * i, 2 * j] += w * r0 + u * t0
                    k[2 * i, 2 * j + 1] += w * r1 + u * t1
                    k[2 * i + 1, 2 * j] += w * r2 + u * t2
                    k[2 * i + 1, 2 * j + 1] += w * r3 + u * t3
                i = n * vpn + last
                w = 0.0 if bends else slope[kind, point, i]
                u = director[point, n]
                k[2 * i, 2 * j] += u * d0 + w * t0
                k[2 * i, 2 * j + 1] += u * d1 + w * t1
                k[2 * i + 1, 2 * j] += u * d2 + w * t2
                k[2 * i + 1, 2 * j + 1] += u * d3 + w * t3
