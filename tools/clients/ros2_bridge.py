#!/usr/bin/env python3
"""lilod to ROS 2: nav_msgs/Odometry on /odom and the transform odom -> velodyne."""
import rclpy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from tf2_ros import TransformBroadcaster

from lilo_client import LiloClient, covariance_in_parent_frame


def copy(names, source, target):
    for name in names:
        setattr(target, name, float(source[name]))


def main():
    rclpy.init()
    node = rclpy.create_node("lilo_bridge")
    publisher = node.create_publisher(Odometry, "odom", 10)
    broadcaster = TransformBroadcaster(node)
    for pose in LiloClient().poses():
        odometry = Odometry(child_frame_id=pose["child_frame_id"])
        odometry.header.frame_id = pose["frame_id"]
        odometry.header.stamp.sec = pose["stamp"]["sec"]
        odometry.header.stamp.nanosec = pose["stamp"]["nsec"]
        copy("xyz", pose["position"], odometry.pose.pose.position)
        copy("xyzw", pose["orientation"], odometry.pose.pose.orientation)
        if "covariance" in pose:
            odometry.pose.covariance = covariance_in_parent_frame(pose)
        if "twist" in pose:
            copy("xyz", pose["twist"]["linear"], odometry.twist.twist.linear)
            copy("xyz", pose["twist"]["angular"], odometry.twist.twist.angular)
        publisher.publish(odometry)
        transform = TransformStamped(header=odometry.header, child_frame_id=odometry.child_frame_id)
        copy("xyz", pose["position"], transform.transform.translation)
        copy("xyzw", pose["orientation"], transform.transform.rotation)
        broadcaster.sendTransform(transform)


if __name__ == "__main__":
    main()
