# SPDX-License-Identifier: BSD-3-Clause
"""Poses of lilod as ROS has them: the frames of REP-105, the covariances of nav_msgs/Odometry."""
from lilo_ros.transform import Transform, congruent, cross, rotated, turned

VALID = ("tracking", "degraded")
UNKNOWN_VARIANCE = 1e6  # a filter takes zeros for certainty


class Motion:
    """Where the child frame is and how it moves; twist and covariance are in the child frame."""

    def __init__(self, pose):
        p, q = pose["position"], pose["orientation"]
        self.T_odom_child = Transform([p[k] for k in "xyz"], [q[k] for k in "xyzw"])
        twist = pose.get("twist")
        self.linear = twist and tuple(twist["linear"][k] for k in "xyz")
        self.angular = twist and tuple(twist["angular"][k] for k in "xyz")
        self.covariance = pose.get("covariance")

    def of_base(self, T_base_sensor):
        """The same motion, told of another frame on the robot, whose first pose is the origin."""
        T = T_base_sensor
        self.T_odom_child = T @ self.T_odom_child @ T.inverse()
        if self.linear is not None:
            self.angular = rotated(T.rotation, self.angular)
            turning = cross(self.angular, T.position)
            moving = rotated(T.rotation, self.linear)
            self.linear = tuple(a - b for a, b in zip(moving, turning))
        if self.covariance is not None:
            self.covariance = congruent(T.adjoint(), self.covariance)
        return self

    def covariance_in_parent(self):
        """36 numbers about the axes of the parent frame, where ROS wants them."""
        if self.covariance is None:
            return diagonal([UNKNOWN_VARIANCE] * 6)
        return turned(self.T_odom_child.rotation, self.covariance)


def diagonal(values):
    return [values[k // 6] if k % 7 == 0 else 0.0 for k in range(36)]


class Sessions:
    """Keeps odom continuous, as REP-105 demands: a session has an origin of its own, and what moved
    between two sessions nobody knows. The next one begins where the last valid pose was."""

    def __init__(self, continuous):
        self._continuous = continuous
        self._session = None
        self._T_odom_session = Transform()
        self._last = None

    def place(self, session, motion):
        """Puts a valid pose into odom. True when it is the first of a session."""
        new = session != self._session
        if new and self._continuous and self._last is not None:
            self._T_odom_session = self._last @ motion.T_odom_child.inverse()
        self._session = session
        motion.T_odom_child = self._T_odom_session @ motion.T_odom_child
        self._last = motion.T_odom_child
        return new
