# SPDX-License-Identifier: BSD-3-Clause
"""ros2 launch lilo_ros lilo.launch.py host:=192.168.1.20 base_frame:=base_link"""
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = {  # name: how its text becomes the parameter
    "host": str,
    "port": int,
    "odom_topic": str,
    "odom_frame": str,
    "base_frame": str,
    "publish_tf": lambda text: text.lower() == "true",
}


def bridge(context):
    """What is given on the command line wins over the file; what is not is the file's."""
    given = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    values = {name: ARGUMENTS[name](text) for name, text in given.items() if text}
    return [Node(package="lilo_ros", executable="bridge", name="lilo_bridge", output="screen",
                 parameters=[LaunchConfiguration("params_file")] + ([values] if values else []))]


def generate_launch_description():
    file = os.path.join(get_package_share_directory("lilo_ros"), "config", "lilo.yaml")
    declared = [DeclareLaunchArgument(name, default_value="", description="empty: as params_file")
                for name in ARGUMENTS]
    declared.append(DeclareLaunchArgument("params_file", default_value=file))
    return LaunchDescription(declared + [OpaqueFunction(function=bridge)])
