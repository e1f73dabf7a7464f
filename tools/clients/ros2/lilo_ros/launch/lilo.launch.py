"""ros2 launch lilo_ros lilo.launch.py host:=192.168.1.20 base_frame:=base_link"""
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

ARGUMENTS = {  # name: (default, type)
    "host": ("127.0.0.1", str),
    "port": ("9871", int),
    "odom_frame": ("", str),
    "base_frame": ("", str),
    "publish_tf": ("true", bool),
}


def generate_launch_description():
    share = get_package_share_directory("lilo_ros")
    params = LaunchConfiguration("params_file")
    values = {name: ParameterValue(LaunchConfiguration(name), value_type=kind)
              for name, (_, kind) in ARGUMENTS.items()}
    declared = [DeclareLaunchArgument(name, default_value=default)
                for name, (default, _) in ARGUMENTS.items()]
    declared.append(DeclareLaunchArgument(
        "params_file", default_value=os.path.join(share, "config", "lilo.yaml")))
    return LaunchDescription(declared + [
        Node(package="lilo_ros", executable="bridge", name="lilo_bridge", output="screen",
             parameters=[params, values])])
