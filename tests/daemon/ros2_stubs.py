"""Runs a ROS 2 node in Python without ROS: ros2_stubs.py NODE.py PORT_OF_LILOD. Prints the first message it
publishes, as JSON, and ends."""
import json
import os
import runpy
import sys
import types


class Message:
    """Any message: fields appear as they are used, as messages of their own."""

    def __init__(self, **fields):
        self.__dict__.update(fields)

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return self.__dict__.setdefault(name, Message())


class Once:
    def publish(self, message):
        print(json.dumps(message, default=lambda m: m.__dict__), flush=True)
        os._exit(0)


def module(name, **content):
    sys.modules[name] = types.ModuleType(name)
    sys.modules[name].__dict__.update(content)


module("rclpy", init=lambda: None,
       create_node=lambda name: Message(create_publisher=lambda *what: Once()))
module("geometry_msgs")
module("geometry_msgs.msg", TransformStamped=Message)
module("nav_msgs")
module("nav_msgs.msg", Odometry=Message)
module("tf2_ros", TransformBroadcaster=lambda node: Message())
# LiloClient() asks port 9871 of this computer: the test's port goes in its place.
sys.path.insert(0, os.path.dirname(sys.argv[1]))
import lilo_client
lilo_client.LiloClient.__init__.__defaults__ = ("127.0.0.1", int(sys.argv[2]), 5.0)
runpy.run_path(sys.argv[1], run_name="__main__")
