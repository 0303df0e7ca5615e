"""What turns on the tower: jib, counter-jib and trolley as one body with deflections, in the head's axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from towercrane.kernels.algebra import Vector, cross

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.head import Head
    from towercrane.cranes.tower.equations.jib import Path, Sums, Trolley
    from towercrane.cranes.tower.modes.mass_sums import Straight


class Body(NamedTuple):
    """Mass, first moments, moments of inertia (xx, xy, xz, yy, yz, zz), force and moment about the tower's top.

    The force is minus the inertia with second derivatives zero, minus the weight.
    """

    mass: Any
    first: Vector
    inertia: tuple[Any, ...]
    force: Vector
    moment: Vector

    def with_trolley(self, mass: Any, place: Vector, pull: Vector) -> Body:
        """With a trolley of this mass at this place and this force on it."""
        (sx, sy, sz), (ixx, ixy, ixz, iyy, iyz, izz) = self.first, self.inertia
        x, y, z = place
        px, py, pz = pull
        first = (sx + mass * x, sy + mass * y, sz + mass * z)
        inertia = (ixx + mass * (y * y + z * z), ixy - mass * x * y, ixz - mass * x * z, iyy + mass * (x * x + z * z),
                   iyz - mass * y * z, izz + mass * (x * x + y * y))  # fmt: skip
        (fx, fy, fz), (mx, my, mz) = self.force, self.moment
        moment = (mx + y * pz - z * py, my + z * px - x * pz, mz + x * py - y * px)
        return Body(self.mass + mass, first, inertia, (fx + px, fy + py, fz + pz), moment)

    def pushed(self, force: Vector, moment: Vector) -> Body:
        """With a force and a moment on it."""
        (fx, fy, fz), (mx, my, mz) = self.force, self.moment
        px, py, pz = force
        rolling, pitching, turning = moment
        return self._replace(force=(fx + px, fy + py, fz + pz), moment=(mx + rolling, my + pitching, mz + turning))


def body_of(straight: Straight, head: Head, felt: Vector, left: Sums, up: Sums) -> Body:
    """What turns, or a part of it, without trolley; felt is the acceleration against gravity of the tower's top."""
    wx, wy, wz = head.spin
    alx, aly, alz = head.spin_bias
    spin, (gx, gy, gz) = wx * wx + wy * wy + wz * wz, felt
    mass, static_moment, roll, pitch, yaw = straight
    sx, sy, sz, ayd, azd = static_moment, left.first, up.first, left.first_rate, up.first_rate
    by, bz, byd, bzd = left.second, up.second, left.second_rate, up.second_rate
    qyy, qzz, qyz = left.own, up.own, left.other
    eyy, ezz, eyz, ezy = left.own_rate, up.own_rate, left.other_rate, up.other_rate
    ixx, ixy, ixz = roll + qyy + qzz, -by, -bz
    iyy, iyz, izz = pitch + qzz, -qyz, yaw + qyy
    along = wx * sx + wy * sy + wz * sz
    fx = -(aly * sz - alz * sy + wx * along - spin * sx + 2.0 * (wy * azd - wz * ayd) + mass * gx)
    fy = -(alz * sx - alx * sz + wy * along - spin * sy - 2.0 * wx * azd + mass * gy)
    fz = -(alx * sy - aly * sx + wz * along - spin * sz + 2.0 * wx * ayd + mass * gz)
    lx, ly, lz = ixx * wx + ixy * wy + ixz * wz, ixy * wx + iyy * wy + iyz * wz, ixz * wx + iyz * wy + izz * wz
    mx = ixx * alx + ixy * aly + ixz * alz + wy * lz - wz * ly + sy * gz - sz * gy
    my = ixy * alx + iyy * aly + iyz * alz + wz * lx - wx * lz + sz * gx - sx * gz
    mz = ixz * alx + iyz * aly + izz * alz + wx * ly - wy * lx + sx * gy - sy * gx
    # Coriolis moment 2 sum m s x (w x s').
    mx = mx + 2.0 * (eyy + ezz) * wx
    my = my + 2.0 * ((eyy + ezz) * wy - byd * wx - eyy * wy - eyz * wz)
    mz = mz + 2.0 * ((eyy + ezz) * wz - bzd * wx - ezy * wy - ezz * wz)
    # Sections that turn by themselves: w x h, their moment of momentum h = (0, -h_up, h_left).
    mx = mx + (wy * left.turned_rate + wz * up.turned_rate)
    my = my - wx * left.turned_rate
    mz = mz - wx * up.turned_rate
    return Body(mass, (sx, sy, sz), (ixx, ixy, ixz, iyy, iyz, izz), (fx, fy, fz), (-mx, -my, -mz))


class Carried(NamedTuple):
    """The trolley on the jib, in the head's axes: place, velocity, acceleration while no rate changes."""

    place: Vector
    velocity: Vector
    bias: Vector


def carried(head: Head, trolley: Trolley, left: Path, up: Path) -> Carried:
    """Motion of the trolley on the deflected jib."""
    wx, wy, wz = head.spin
    place = x, y, z = trolley.x, left.deflection, up.deflection
    xd, yd, zd = trolley.rate, left.rate, up.rate
    spin, along = wx * wx + wy * wy + wz * wz, wx * x + wy * y + wz * z
    turned = cross(head.spin_bias, place)
    bias = (
        turned[0] + wx * along - spin * x + 2.0 * (wy * zd - wz * yd) + trolley.acceleration,
        turned[1] + wy * along - spin * y + 2.0 * (wz * xd - wx * zd) + left.bias,
        turned[2] + wz * along - spin * z + 2.0 * (wx * yd - wy * xd) + up.bias,
    )
    top = head.top
    velocity = (
        top[0] + wy * z - wz * y + xd,
        top[1] + wz * x - wx * z + yd,
        top[2] + wx * y - wy * x + zd,
    )
    return Carried(place, velocity, bias)
