# SPDX-License-Identifier: BSD-3-Clause
"""lilo_ros against stand-ins for ROS 2, message by message: lilo_ros_test.py FOLDER_OF_CLIENTS"""
import importlib.util
import math
import os
import sys
import unittest
import xml.etree.ElementTree

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import stand_ins

CLIENTS = sys.argv.pop() if len(sys.argv) > 1 else "tools/clients"
PACKAGE = os.path.join(CLIENTS, "ros2", "lilo_ros")
sys.path[:0] = [PACKAGE, CLIENTS]
import lilo_client
from lilo_ros import bridge, odometry, transform

HALF = math.sqrt(0.5)
LEFT = {"x": 0.0, "y": 0.0, "z": HALF, "w": HALF}  # a quarter turn
AHEAD = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
COVARIANCE = [0.01 * (k // 6 + 1) if k % 7 == 0 else 0.0 for k in range(36)]


def pose(x=1.0, status="tracking", orientation=AHEAD, session="a", seq=0, **more):
    return {"v": "2.0", "timestamp": 5.25, "session": session, "seq": seq, "pose": {
        "stamp": {"sec": 5, "nsec": 250000000}, "frame_id": "odom", "child_frame_id": "velodyne",
        "status": status, "position": {"x": x, "y": 2.0, "z": 3.0}, "orientation": orientation,
        "latency_ms": 3.0, "lost_packets": 0, **more}}


TWIST = {"linear": {"x": 4.0, "y": 5.0, "z": 6.0}, "angular": {"x": 0.1, "y": 0.2, "z": 0.3}}


def health(status="tracking", complaints=()):
    return {"v": "2.0", "timestamp": 5.5, "session": "a", "health": {
        "status": status, "complaints": list(complaints), "latency_ms": {"p50": 2.5, "p99": 3.5}}}


class LiloRos(unittest.TestCase):
    def setUp(self):
        stand_ins.published.clear()
        stand_ins.logged.clear()
        stand_ins.PARAMETERS.clear()
        stand_ins.TRANSFORMS.clear()

    def run_bridge(self, *datagrams, **parameters):
        stand_ins.PARAMETERS.update(parameters)
        node = bridge.Bridge()
        for datagram in datagrams:
            node.take(datagram)
        self.node = node
        self.addCleanup(node._client.close)

    def on(self, topic):
        return [message for name, message in stand_ins.published if name == topic]

    def position(self, message):
        p = message.pose.pose.position
        return p.x, p.y, p.z

    def test_an_odometry_has_every_field(self):
        self.run_bridge(pose(orientation=LEFT, twist=TWIST, covariance=COVARIANCE))
        (message,) = self.on("odom")
        self.assertEqual((message.header.frame_id, message.child_frame_id), ("odom", "velodyne"))
        self.assertEqual((message.header.stamp.sec, message.header.stamp.nanosec), (5, 250000000))
        self.assertEqual(self.position(message), (1.0, 2.0, 3.0))
        self.assertAlmostEqual(message.pose.pose.orientation.z, HALF)
        self.assertEqual(message.twist.twist.linear.y, 5.0)
        self.assertEqual(message.twist.twist.angular.z, 0.3)
        self.assertEqual(message.twist.covariance[0], 0.05 * 0.05)
        self.assertEqual(message.twist.covariance[35], 0.02 * 0.02)
        # x of the parent is y of the child and the other way round: the variances change places.
        for place, variance in enumerate([0.02, 0.01, 0.03, 0.05, 0.04, 0.06]):
            self.assertAlmostEqual(message.pose.covariance[7 * place], variance)

    def test_every_covariance_is_about_the_axes_of_the_parent(self):
        # By hand, for a quarter turn to the left: x of the parent is -y of the child, y is its x.
        of_child = ((1, -1), (0, 1), (2, 1), (4, -1), (3, 1), (5, 1))  # axis, sign
        told = [1.0 + 0.1 * (k // 6) + 0.01 * (k % 6) for k in range(36)]
        self.run_bridge(pose(orientation=LEFT, covariance=told))
        (message,) = self.on("odom")
        for row, (i, row_sign) in enumerate(of_child):
            for column, (j, column_sign) in enumerate(of_child):
                self.assertAlmostEqual(message.pose.covariance[6 * row + column],
                                       row_sign * column_sign * told[6 * i + j])

    def test_a_transform_comes_with_it(self):
        self.run_bridge(pose(orientation=LEFT))
        (message,) = self.on("/tf")
        self.assertEqual((message.header.frame_id, message.child_frame_id), ("odom", "velodyne"))
        self.assertEqual(message.transform.translation.x, 1.0)
        self.assertAlmostEqual(message.transform.rotation.w, HALF)

    def test_tf_can_be_left_to_a_filter(self):
        self.run_bridge(pose(), publish_tf=False)
        self.assertEqual((len(self.on("odom")), len(self.on("/tf"))), (1, 0))

    def test_what_is_not_known_is_never_certain(self):
        self.run_bridge(pose())
        (message,) = self.on("odom")
        self.assertEqual(message.pose.covariance[0], odometry.UNKNOWN_VARIANCE)
        self.assertEqual(message.twist.covariance[14], odometry.UNKNOWN_VARIANCE)

    def test_guesses_are_not_published(self):
        self.run_bridge(pose(status="initializing"), pose(status="lost"), pose(status="novel"))
        self.assertEqual(len(self.on("odom")) + len(self.on("/tf")), 0)

    def test_degraded_poses_are(self):
        self.run_bridge(pose(status="degraded"))
        self.assertEqual(len(self.on("odom")), 1)

    def test_a_new_session_goes_on_where_the_last_valid_pose_was(self):
        self.run_bridge(pose(x=10.0), pose(x=50.0, status="lost"), pose(x=0.0, session="b"),
                        pose(x=1.0, session="b"))
        xs = [self.position(message)[0] for message in self.on("odom")]
        self.assertEqual(xs, [10.0, 10.0, 11.0])

    def test_a_new_session_may_have_its_own_origin(self):
        self.run_bridge(pose(x=10.0), pose(x=0.0, session="b"), continuous=False)
        self.assertEqual([self.position(m)[0] for m in self.on("odom")], [10.0, 0.0])

    def test_sessions_are_signalled_once_each(self):
        self.run_bridge(pose(), pose(seq=1), pose(session="b", status="initializing"),
                        pose(session="b", seq=1))
        self.assertEqual([message.data for message in self.on("~/session")], ["a", "b"])
        self.assertEqual(len(stand_ins.logged), 1)  # the first one is no news
        self.assertEqual(self.node.publishers["~/session"].qos.durability, "transient_local")

    def test_base_link_by_tf(self):
        stand_ins.TRANSFORMS["base_link", "velodyne"] = ((1.0, 0.0, 0.5), (0.0, 0.0, 0.0, 1.0))
        turning = {"linear": {"x": 0.0, "y": 0.0, "z": 0.0},
                   "angular": {"x": 0.0, "y": 0.0, "z": 1.0}}
        self.run_bridge(pose(orientation=LEFT, twist=turning, covariance=COVARIANCE),
                        base_frame="base_link")
        (message,) = self.on("odom")
        self.assertEqual(message.child_frame_id, "base_link")
        # T_base_sensor T T_sensor_base: the base is 1 m behind the sensor, which looks left.
        for found, expected in zip(self.position(message), (1.0 + 1.0, 2.0 - 1.0, 3.0)):
            self.assertAlmostEqual(found, expected)
        # It turns about the sensor, 1 m ahead of it: it moves to the right.
        self.assertAlmostEqual(message.twist.twist.linear.y, -1.0)
        # What yaw is not known by, 1 m of lever turns into sideways; x of the parent now.
        self.assertAlmostEqual(message.pose.covariance[0], 0.02 + 0.06 + 0.25 * 0.04, places=6)

    def test_nothing_before_tf_knows_the_base(self):
        self.run_bridge(pose(), pose(seq=1), base_frame="base_link")
        self.assertEqual(self.on("odom"), [])
        self.assertEqual(len(stand_ins.logged), 1)  # complained of once

    def test_frames_and_topics_by_parameters(self):
        self.run_bridge(pose(), odom_frame="lilo_odom", odom_topic="lilo/odom", reliable=False,
                        depth=3)
        (message,) = self.on("lilo/odom")
        self.assertEqual(message.header.frame_id, "lilo_odom")
        qos = self.node.publishers["lilo/odom"].qos
        self.assertEqual((qos.depth, qos.reliability), (3, "best_effort"))

    def test_health_becomes_diagnostics(self):
        cases = {("tracking", ()): b"\x00", ("tracking", ("packets lost",)): b"\x01",
                 ("degraded", ("degraded",)): b"\x01", ("initializing", ()): b"\x01",
                 ("lost", ("lost",)): b"\x02", ("silent", ("sensor silent",)): b"\x02"}
        self.run_bridge(*[health(*case) for case in cases])
        statuses = [message.status[0] for message in self.on("/diagnostics")]
        self.assertEqual([status.level for status in statuses], list(cases.values()))
        self.assertEqual(statuses[1].message, "tracking, packets lost")
        self.assertEqual(statuses[0].hardware_id, "lilod at 127.0.0.1:9871")
        values = {each.key: each.value for each in statuses[0].values}
        self.assertEqual(values["latency_ms.p99"], "3.5")
        self.assertEqual(values["session"], "a")

    def test_a_quiet_lilod_is_stale(self):
        self.run_bridge()
        self.node._client = type("Quiet", (), {"messages": lambda self, timeout_s: iter(())})()
        answers = iter([True, False])
        bridge.rclpy.ok = lambda: next(answers)
        self.node.run()
        bridge.rclpy.ok = lambda: True
        self.assertEqual(self.on("/diagnostics")[0].status[0].level, b"\x03")

    def test_another_protocol_is_an_error_and_not_the_end(self):
        self.run_bridge()
        bridge.QUIET_S = 0.0

        class Other:
            def messages(self, timeout_s):
                raise lilo_client.VersionError("lilod at x speaks protocol 3.0")
        self.node._client = Other()
        self.node._client.close = lambda: None
        answers = iter([True, True, False])
        bridge.rclpy.ok = lambda: next(answers)
        self.node.run()
        bridge.rclpy.ok = lambda: True
        statuses = [message.status[0] for message in self.on("/diagnostics")]
        self.assertEqual([status.level for status in statuses], [b"\x02", b"\x02"])
        self.assertEqual(statuses[0].message, "lilod at x speaks protocol 3.0")
        self.assertEqual(len(stand_ins.logged), 1)

    def launched(self, **given):
        """The parameters that the launch file gives the bridge."""
        path = os.path.join(PACKAGE, "launch", "lilo.launch.py")
        spec = importlib.util.spec_from_file_location("lilo_launch", path)
        file = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(file)
        (actions,) = file.generate_launch_description().positional
        context = {action.positional[0]: given.get(action.positional[0], action.default_value)
                   for action in actions[:-1]}
        (node,) = actions[-1].function(context)
        self.assertEqual((node.package, node.executable), ("lilo_ros", "bridge"))
        file, *values = node.parameters
        return file.perform(context), values

    def test_the_launch_file_leaves_the_parameters_file_alone(self):
        self.assertEqual(self.launched(), ("/share/lilo_ros/config/lilo.yaml", []))
        self.assertEqual(self.launched(params_file="/my.yaml"), ("/my.yaml", []))

    def test_arguments_of_the_launch_file_are_parameters(self):
        _, (values,) = self.launched(host="10.0.0.2", port="9881", odom_topic="o", odom_frame="f",
                                     base_frame="base_link", publish_tf="False")
        self.assertEqual(values, {"host": "10.0.0.2", "port": 9881, "odom_topic": "o",
                                  "odom_frame": "f", "base_frame": "base_link",
                                  "publish_tf": False})
        for name, value in values.items():
            self.assertIs(type(value), type(bridge.PARAMETERS[name]))

    def test_inverse_and_product_of_transforms(self):
        T = transform.Transform((1.0, 2.0, 3.0), (0.5, 0.5, 0.5, 0.5))
        same = T @ T.inverse()
        for found, expected in zip(same.position + same.rotation, (0, 0, 0, 0, 0, 0, 1)):
            self.assertAlmostEqual(found, expected)

    def test_the_client_turns_covariances_likewise(self):
        covariance = [float(6 * min(k // 6, k % 6) + max(k // 6, k % 6)) for k in range(36)]
        told = pose(orientation=LEFT, covariance=covariance)["pose"]
        turned = odometry.Motion(told).covariance_in_parent()
        for found, expected in zip(turned, lilo_client.covariance_in_parent_frame(told)):
            self.assertAlmostEqual(found, expected)

    def test_the_package_names_what_it_imports(self):
        root = xml.etree.ElementTree.parse(os.path.join(PACKAGE, "package.xml")).getroot()
        depends = {each.text for each in root.findall("exec_depend")}
        for name in ("rclpy", "nav_msgs", "geometry_msgs", "diagnostic_msgs", "std_msgs", "tf2_ros"):
            self.assertIn(name, depends)

    def test_the_example_file_has_the_defaults(self):
        with open(os.path.join(PACKAGE, "config", "lilo.yaml"), encoding="utf-8") as file:
            lines = [line.split("#")[0].strip() for line in file]
        names = [line.split(":")[0] for line in lines if ": " in line]
        self.assertEqual(names, list(bridge.PARAMETERS))


if __name__ == "__main__":
    unittest.main()
