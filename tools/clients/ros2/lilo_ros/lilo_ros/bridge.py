# SPDX-License-Identifier: BSD-3-Clause
"""lilod to ROS 2: nav_msgs/Odometry, TF odom -> base, diagnostics, and the session."""
import threading
import time

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from lilo_client import LiloClient, VersionError
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import String
from tf2_ros import Buffer, TransformBroadcaster, TransformException, TransformListener

from lilo_ros import messages
from lilo_ros.odometry import VALID, Motion, Sessions
from lilo_ros.transform import Transform

QUIET_S = 3.0  # health comes once a second
PARAMETERS = {
    "host": "127.0.0.1",
    "port": 9871,
    "odom_topic": "odom",
    "diagnostics_topic": "/diagnostics",
    "odom_frame": "",
    "base_frame": "",
    "publish_tf": True,
    "continuous": True,
    "reliable": True,
    "depth": 10,
    "twist_stddev": [0.05, 0.05, 0.05, 0.02, 0.02, 0.02],
}


class Bridge(Node):
    def __init__(self):
        super().__init__("lilo_bridge")
        for name, default in PARAMETERS.items():
            self.declare_parameter(name, default)
        self._client = LiloClient(self._value("host"), self._value("port"))
        self._where = f"lilod at {self._value('host')}:{self._value('port')}"
        self._sessions = Sessions(self._value("continuous"))
        self._make_publishers()
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._session = None
        self._heard = time.monotonic()
        self._complained_of = ""
        self._waiting_for = None  # the transform that is missing, once it was complained of

    def _value(self, name):
        return self.get_parameter(name).value

    def _make_publishers(self):
        reliable = self._value("reliable")
        qos = QoSProfile(
            depth=self._value("depth"),
            reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT)
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._odometry = self.create_publisher(Odometry, self._value("odom_topic"), qos)
        self._diagnostics = self.create_publisher(
            DiagnosticArray, self._value("diagnostics_topic"), 10)
        self._sessions_topic = self.create_publisher(String, "~/session", kept)
        self._broadcaster = TransformBroadcaster(self) if self._value("publish_tf") else None

    def run(self):
        """Until the node ends. On a thread of its own: publishing is safe from any."""
        while rclpy.ok():
            try:
                self._follow()
            except VersionError as error:  # until lilod or this package is another
                self._complain(str(error))
                time.sleep(QUIET_S)

    def _follow(self):
        for message in self._client.messages(timeout_s=QUIET_S):
            self._heard = time.monotonic()
            self.take(message)
            if not rclpy.ok():
                return
        self._diagnostics.publish(messages.stale_diagnostics(
            self.get_clock().now().to_msg(), self._where, time.monotonic() - self._heard))

    def _complain(self, text):
        if text != self._complained_of:
            self.get_logger().error(text)
        self._complained_of = text
        self._diagnostics.publish(messages.error_diagnostics(
            self.get_clock().now().to_msg(), self._where, text))

    def take(self, message):
        """One datagram of lilod."""
        if "pose" in message:
            self._follow_session(message["session"])
            self._take_pose(message["session"], message["pose"])
        elif "health" in message:
            self._diagnostics.publish(messages.health_diagnostics(
                self.get_clock().now().to_msg(), message["health"], self._where,
                message["session"]))

    def _follow_session(self, session):
        if session == self._session:
            return
        if self._session is not None:
            self.get_logger().warning(f"lilod began session {session}: what was before is another "
                                      "map, and the motion in between is unknown")
        self._session = session
        self._sessions_topic.publish(String(data=session))

    def _take_pose(self, session, pose):
        if pose["status"] not in VALID:
            return  # a guess, or not sure yet: REP-105 has no place for these
        frames = (self._value("odom_frame") or pose["frame_id"],
                  self._value("base_frame") or pose["child_frame_id"])
        motion = Motion(pose)
        if frames[1] != pose["child_frame_id"]:
            T_base_sensor = self._mount(frames[1], pose["child_frame_id"])
            if T_base_sensor is None:
                return
            motion.of_base(T_base_sensor)
        self._sessions.place(session, motion)
        self._odometry.publish(messages.odometry(pose["stamp"], frames, motion,
                                                 self._value("twist_stddev")))
        if self._broadcaster is not None:
            self._broadcaster.sendTransform(messages.transform(pose["stamp"], frames, motion))

    def _mount(self, base, sensor):
        """T_base_sensor as TF knows it (robot_state_publisher, static_transform_publisher)."""
        try:
            found = self._buffer.lookup_transform(base, sensor, rclpy.time.Time()).transform
        except TransformException as error:
            if self._waiting_for != (base, sensor):
                self.get_logger().warning(f"no odometry before TF knows {base} <- {sensor}: {error}")
            self._waiting_for = (base, sensor)
            return None
        self._waiting_for = None
        t, q = found.translation, found.rotation
        return Transform((t.x, t.y, t.z), (q.x, q.y, q.z, q.w))


def main():
    rclpy.init()
    node = Bridge()
    threading.Thread(target=node.run, daemon=True).start()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
