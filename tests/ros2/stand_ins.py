# SPDX-License-Identifier: BSD-3-Clause
"""The parts of ROS 2 that lilo_ros uses, without ROS: what is published is kept, and printed as one
JSON line a message where PRINT is set. Import this before lilo_ros."""
import json
import sys
import types

PRINT = False
PARAMETERS = {}  # of the node, over its defaults
TRANSFORMS = {}  # (parent, child): (position, rotation)
published = []  # (topic, message)
logged = []


class Message:
    """Any message: fields appear as they are used, as messages of their own."""

    def __init__(self, **fields):
        self.__dict__.update(fields)

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return self.__dict__.setdefault(name, Message())


class Odometry(Message):
    pass


class TransformStamped(Message):
    pass


class KeyValue(Message):
    pass


class String(Message):
    pass


class DiagnosticArray(Message):
    pass


class DiagnosticStatus(Message):
    OK, WARN, ERROR, STALE = (bytes([k]) for k in range(4))


class QoSProfile(Message):
    pass


class TransformException(Exception):
    pass


def plain(message):
    return message[0] if isinstance(message, bytes) else message.__dict__


def keep(topic, message):
    published.append((topic, message))
    if PRINT:
        print(json.dumps({topic: message}, default=plain), flush=True)


class Publisher:
    def __init__(self, kind, topic, qos):
        self.kind, self.topic, self.qos = kind, topic, qos

    def publish(self, message):
        assert isinstance(message, self.kind), (self.topic, message)
        keep(self.topic, message)


class Node:
    def __init__(self, name):
        self.name = name
        self.parameters = {}
        self.publishers = {}

    def declare_parameter(self, name, default):
        value = PARAMETERS.get(name, default)
        assert type(value) is type(default), name
        self.parameters[name] = value

    def get_parameter(self, name):
        return Message(value=self.parameters[name])

    def create_publisher(self, kind, topic, qos):
        self.publishers[topic] = Publisher(kind, topic, qos)
        return self.publishers[topic]

    def get_clock(self):
        return types.SimpleNamespace(now=lambda: types.SimpleNamespace(
            to_msg=lambda: Message(sec=1, nanosec=2)))

    def get_logger(self):
        return types.SimpleNamespace(warning=logged.append, error=logged.append)

    def destroy_node(self):
        pass


class Broadcaster:
    def __init__(self, node):
        pass

    def sendTransform(self, message):
        assert isinstance(message, TransformStamped)
        keep("/tf", message)


class Buffer:
    def lookup_transform(self, parent, child, time):
        if (parent, child) not in TRANSFORMS:
            raise TransformException(f"{parent} is not connected to {child}")
        position, rotation = TRANSFORMS[parent, child]
        return Message(transform=Message(translation=Message(**dict(zip("xyz", position))),
                                         rotation=Message(**dict(zip("xyzw", rotation)))))


def module(name, **content):
    sys.modules[name] = types.ModuleType(name)
    sys.modules[name].__dict__.update(content)


class Launched(Message):
    """An action or a description of ROS 2's launch: how it was made."""

    def __init__(self, *positional, **named):
        super().__init__(positional=positional, **named)


class LaunchConfiguration(Launched):
    def perform(self, context):
        return context[self.positional[0]]


def install_launch():
    module("launch", LaunchDescription=Launched)
    module("launch.actions", DeclareLaunchArgument=Launched, OpaqueFunction=Launched)
    module("launch.substitutions", LaunchConfiguration=LaunchConfiguration)
    module("launch_ros")
    module("launch_ros.actions", Node=Launched)
    module("ament_index_python")
    module("ament_index_python.packages", get_package_share_directory=lambda name: "/share/" + name)


def install():
    install_launch()
    module("rclpy", init=lambda: None, ok=lambda: True, spin=lambda node: None,
           try_shutdown=lambda: None)
    module("rclpy.node", Node=Node)
    module("rclpy.time", Time=Message)
    sys.modules["rclpy"].time = sys.modules["rclpy.time"]
    module("rclpy.qos", QoSProfile=QoSProfile,
           DurabilityPolicy=Message(TRANSIENT_LOCAL="transient_local"),
           ReliabilityPolicy=Message(RELIABLE="reliable", BEST_EFFORT="best_effort"))
    for package, kinds in {"diagnostic_msgs": [DiagnosticArray, DiagnosticStatus, KeyValue],
                           "geometry_msgs": [TransformStamped], "nav_msgs": [Odometry],
                           "std_msgs": [String]}.items():
        module(package)
        module(package + ".msg", **{kind.__name__: kind for kind in kinds})
    module("tf2_ros", Buffer=Buffer, TransformBroadcaster=Broadcaster,
           TransformException=TransformException, TransformListener=lambda buffer, node: None)


install()
