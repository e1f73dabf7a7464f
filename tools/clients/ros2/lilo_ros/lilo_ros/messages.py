# SPDX-License-Identifier: BSD-3-Clause
"""ROS messages from what lilod says. No state."""
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry

from lilo_ros.odometry import UNKNOWN_VARIANCE, diagonal

WARN = ("initializing", "degraded")


def set_fields(names, values, target):
    for name, value in zip(names, values):
        setattr(target, name, float(value))


def set_header(header, stamp, frame_id):
    header.stamp.sec = stamp["sec"]
    header.stamp.nanosec = stamp["nsec"]
    header.frame_id = frame_id


def odometry(stamp, frames, motion, twist_stddev):
    message = Odometry()
    set_header(message.header, stamp, frames[0])
    message.child_frame_id = frames[1]
    set_fields("xyz", motion.T_odom_child.position, message.pose.pose.position)
    set_fields("xyzw", motion.T_odom_child.rotation, message.pose.pose.orientation)
    message.pose.covariance = motion.covariance_in_parent()
    known = motion.linear is not None
    if known:
        set_fields("xyz", motion.linear, message.twist.twist.linear)
        set_fields("xyz", motion.angular, message.twist.twist.angular)
    message.twist.covariance = diagonal(
        [s * s for s in twist_stddev] if known else [UNKNOWN_VARIANCE] * 6)
    return message


def transform(stamp, frames, motion):
    message = TransformStamped()
    set_header(message.header, stamp, frames[0])
    message.child_frame_id = frames[1]
    set_fields("xyz", motion.T_odom_child.position, message.transform.translation)
    set_fields("xyzw", motion.T_odom_child.rotation, message.transform.rotation)
    return message


def flattened(value, path=""):
    """("latency_ms.p99", "3.1") and so on."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from flattened(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        yield path, ", ".join(str(item) for item in value)
    else:
        yield path, str(value)


def level_of(health):
    if health["status"] == "tracking":
        return DiagnosticStatus.WARN if health["complaints"] else DiagnosticStatus.OK
    return DiagnosticStatus.WARN if health["status"] in WARN else DiagnosticStatus.ERROR


def diagnostics(stamp, level, text, hardware_id, values):
    status = DiagnosticStatus()
    status.level = level
    status.name = "lilod: odometry"
    status.message = text
    status.hardware_id = hardware_id
    status.values = [KeyValue(key=key, value=value) for key, value in values]
    message = DiagnosticArray()
    message.header.stamp = stamp
    message.status = [status]
    return message


def health_diagnostics(stamp, health, hardware_id, session):
    text = ", ".join([health["status"]] + health["complaints"])
    values = [("session", session)] + list(flattened(health))
    return diagnostics(stamp, level_of(health), text, hardware_id, values)


def stale_diagnostics(stamp, hardware_id, quiet_s):
    return diagnostics(stamp, DiagnosticStatus.STALE, f"no word from lilod for {quiet_s:.0f} s",
                       hardware_id, [])


def error_diagnostics(stamp, hardware_id, text):
    return diagnostics(stamp, DiagnosticStatus.ERROR, text, hardware_id, [])
